// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <apps/glidar/run/curve_keys.hpp>

#include <glidar/core/error.hpp>
#include <glidar/io/files/atomic_file.hpp>
#include <glidar/io/files/input_file.hpp>

#include <filesystem>
#include <sstream>

namespace glidar::app {
namespace {

link::CurveKeys make_file(const std::string& path, Console& console) {
  const link::CurveKeys keys = link::make_curve_keys();
  AtomicFile file(path, AtomicFile::Permissions::owner_only);
  file.write("public " + keys.public_key + "\nsecret " + keys.secret_key + "\n");
  file.commit();
  console.info("created new keys in " + path + "; clients need the public one: " + keys.public_key);
  return keys;
}

}  // namespace

link::CurveKeys curve_keys(const std::string& path, Console& console) {
  if (!std::filesystem::exists(path)) return make_file(path, console);
  const InputFileKind kind{.name = "a file of two keys", .max_mib = 1, .remedy_if_larger = ""};
  std::istringstream file(read_input_file(path, kind));
  std::string first;
  std::string second;
  link::CurveKeys keys;
  constexpr std::size_t kLetters = 40;
  const bool is_read = file >> first >> keys.public_key >> second >> keys.secret_key &&
                       first == "public" && second == "secret" &&
                       keys.public_key.size() == kLetters && keys.secret_key.size() == kLetters;
  if (is_read) return keys;
  throw Error({.where = "--curve-keys, " + path,
               .found = "no keys",
               .allowed = "two lines, 'public KEY' and 'secret KEY', with 40 letters of Z85 each",
               .remedy = "name a file that does not exist: it is created with new keys"});
}

}  // namespace glidar::app
