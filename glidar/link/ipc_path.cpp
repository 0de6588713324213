// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/ipc_path.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/unique_fd.hpp>

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>

namespace glidar::link {

void require_free_ipc_path(const std::string& path) {
  const std::filesystem::file_status status = std::filesystem::status(path);
  if (!std::filesystem::exists(status)) return;
  if (!std::filesystem::is_socket(status)) {
    throw Error({"ipc://" + path, "a file that is not a socket has this name", "an unused name",
                 "choose another name"});
  }
  sockaddr_un address{.sun_family = AF_UNIX, .sun_path = {}};
  path.copy(address.sun_path, sizeof(address.sun_path) - 1);
  const UniqueFd socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0));
  if (::connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return;  // left by a program that was killed
  }
  throw Error({"ipc://" + path, "another program listens there", "an unused name",
               "end it, or choose another name"});
}

}  // namespace glidar::link
