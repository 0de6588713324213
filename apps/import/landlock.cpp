// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <import/landlock.hpp>

#include <glidar/io/files/unique_fd.hpp>

#include <fcntl.h>
#include <linux/landlock.h>
#include <sys/stat.h>
#include <sys/syscall.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>

namespace glidar::import {
namespace {

// The headers of Debian 12 have version 2 of the interface, current kernels version 7: newer
// constants are defined here (https://docs.kernel.org/userspace-api/landlock.html).

struct RulesetAttributes {
  std::uint64_t files = 0;
  std::uint64_t network = 0;  ///< from version 4
  std::uint64_t scopes = 0;   ///< from version 6
};

constexpr long kTruncationVersion = 3;

constexpr std::uint64_t bits(unsigned count) {
  return (std::uint64_t{1} << count) - 1;
}

/// All access rights that this version of the interface can restrict.
RulesetAttributes everything(long version) {
  RulesetAttributes all;
  all.files = bits(version >= 5 ? 16 : version >= kTruncationVersion ? 15 : version >= 2 ? 14 : 13);
  if (version >= 4) all.network = bits(2);  // bind and connect TCP
  if (version >= 6) all.scopes = bits(2);   // abstract UNIX sockets, signals
  return all;
}

/// An older kernel accepts only the attributes that it knows.
std::size_t size_for(long version) {
  const std::size_t fields = version >= 6 ? 3 : version >= 4 ? 2 : 1;
  return fields * sizeof(std::uint64_t);
}

FileRestriction failed(const char* what) {
  if (errno == ENOSYS) return {"this kernel does not have it"};
  if (errno == EOPNOTSUPP) return {"it is switched off in this kernel"};
  return {std::string(what) + ": " + std::strerror(errno)};
}

}  // namespace

FileRestriction restrict_files(const std::vector<std::filesystem::path>& readable, long newest) {
  const long version = std::min(
      newest, ::syscall(SYS_landlock_create_ruleset, nullptr, 0, LANDLOCK_CREATE_RULESET_VERSION));
  if (version < 1) return failed("querying its version");
  const RulesetAttributes all = everything(version);
  const UniqueFd ruleset(
      static_cast<int>(::syscall(SYS_landlock_create_ruleset, &all, size_for(version), 0)));
  if (!ruleset) return failed("making rules");
  for (const std::filesystem::path& path : readable) {
    const UniqueFd opened(::open(path.c_str(), O_PATH | O_CLOEXEC));
    struct stat info {};
    if (!opened || ::fstat(opened.get(), &info) != 0) return failed("opening what it may read");
    landlock_path_beneath_attr rule{};
    rule.allowed_access = LANDLOCK_ACCESS_FS_READ_FILE;
    if (S_ISDIR(info.st_mode)) rule.allowed_access |= LANDLOCK_ACCESS_FS_READ_DIR;
    rule.parent_fd = opened.get();
    if (::syscall(SYS_landlock_add_rule, ruleset.get(), LANDLOCK_RULE_PATH_BENEATH, &rule, 0) != 0)
      return failed("allowing what it may read");
  }
  if (::syscall(SYS_landlock_restrict_self, ruleset.get(), 0) != 0)
    return failed("applying the rules");
  return {"", version >= kTruncationVersion};
}

}  // namespace glidar::import
