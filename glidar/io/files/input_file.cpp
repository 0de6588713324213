// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/io/files/input_file.hpp>

#include <glidar/core/error.hpp>
#include <glidar/core/text.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>

namespace glidar {
namespace {

constexpr std::uint64_t kBudgetMiB = std::uint64_t{1} << 20U;
constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();

struct BudgetRule {
  const char* name;
  std::uint64_t floor;     ///< for an empty input
  std::uint64_t per_byte;  ///< of the input
  std::uint64_t max;
};

/// In the order of Budget. LZ4 expands a byte to at most 255; chunks of real bags have some MiB.
constexpr std::array<BudgetRule, 11> kRules = {{
    {"decompressed bytes", 256 * kBudgetMiB, 256, kUnlimited},
    {"bytes in memory", 64 * kBudgetMiB, 64, 1024 * kBudgetMiB},
    {"messages", 100'000, 4, kUnlimited},
    {"topics", 4096, 1, 65'536},
    {"bytes of names", kBudgetMiB, 1, 64 * kBudgetMiB},
    {"numbers of a point", 4096, 1, 65'536},
    {"values, with aliases written out", 1'000'000, 2, kUnlimited},
    {"steps of SQLite", 5'000'000, 20, kUnlimited},
    {"numbers in its accessors, each as often as it is read", 4'000'000, 16, kUnlimited},
    {"instances of meshes", 65'536, 1, std::uint64_t{1} << 20U},
    {"vertices and triangles in copies of meshes", 8'000'000, 2, 200'000'000},
}};

}  // namespace

std::uint64_t InputBudget::limit(Budget what) const {
  const BudgetRule& rule = kRules[index(what)];
  constexpr std::uint64_t kMaxInput = kUnlimited >> 10U;  // no product overflows
  return std::min(rule.max, rule.floor + rule.per_byte * std::min(input_bytes_, kMaxInput));
}

void InputBudget::take_name(std::uint64_t bytes, const std::string& place) {
  if (bytes > kMaxNameBytes) {
    throw Error({place, fmt::format("a name of {} bytes", bytes),
                 fmt::format("names of at most {} bytes", kMaxNameBytes),
                 "the file is damaged or malicious"});
  }
  take(Budget::name_bytes, bytes, place);
}

std::string InputBudget::excess(Budget what) const {
  return fmt::format("more than {} {}", limit(what), kRules[index(what)].name);
}

void InputBudget::fail(Budget what, const std::string& place) const {
  throw Error({place, excess(what),
               fmt::format("at most so many for an input of {} bytes", input_bytes_),
               "the file is damaged or malicious"});
}

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, std::string found, std::string allowed = "",
                       std::string remedy = "") {
  throw Error({path.string(), std::move(found), std::move(allowed), std::move(remedy)});
}

[[noreturn]] void fail_to_open(const fs::path& path, int code, const InputFileKind& kind) {
  if (code == ENOENT || code == ENOTDIR) {
    const std::string nearest = nearest_file(path);
    fail(path, "no such file", "",
         nearest.empty() ? "" : "did you mean '" + excerpt(nearest) + "'?");
  }
  if (code == ENXIO || code == ENODEV) fail(path, "not a regular file", kind.name);
  fail(path, "cannot be opened: " + std::generic_category().message(code), "a readable file");
}

void check_size(const fs::path& path, std::uintmax_t size, const InputFileKind& kind) {
  if (size <= kind.max_mib << 20U) return;
  const std::string limit = std::to_string(kind.max_mib) + " MiB";
  fail(path, "a file of more than " + limit, kind.name + " of at most " + limit,
       kind.remedy_if_larger);
}

}  // namespace

InputFile open_input_file(const fs::path& path, const InputFileKind& kind) {
  if (path.native().find('\0') != std::string::npos)
    fail(excerpt(path.native()), "a zero byte in the file name", "a path");
  // O_NONBLOCK: opening a pipe without a writer would block
  InputFile file{UniqueFd(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC | O_NOCTTY))};
  if (!file.descriptor) fail_to_open(path, errno, kind);
  struct stat info {};
  if (::fstat(file.descriptor.get(), &info) != 0) fail_to_open(path, errno, kind);
  if (S_ISDIR(info.st_mode)) fail(path, "a folder", kind.name);
  if (!S_ISREG(info.st_mode)) fail(path, "not a regular file", kind.name);
  file.size = static_cast<std::size_t>(info.st_size);
  check_size(path, file.size, kind);
  return file;
}

std::size_t read_some(const InputFile& file, const fs::path& path, char* to, std::size_t size) {
  for (;;) {
    const ssize_t count = ::read(file.descriptor.get(), to, size);
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno == EINTR) continue;
    fail(path, "cannot be read: " + std::generic_category().message(errno));
  }
}

std::string read_input_file(const fs::path& path, const InputFileKind& kind) {
  const InputFile file = open_input_file(path, kind);
  std::string content(file.size + 1, '\0');  // one more byte, to detect the end of the file
  std::size_t filled = 0;
  for (;;) {
    const std::size_t count =
        read_some(file, path, content.data() + filled, content.size() - filled);
    filled += count;
    if (count == 0) break;
    check_size(path, filled, kind);
    if (filled == content.size()) content.resize(2 * content.size());
  }
  content.resize(filled);
  return content;
}

std::string shown(std::string_view word) {
  constexpr std::size_t kShown = 63;
  return excerpt(word, kShown);
}

std::string read_text_file(const fs::path& file, const TextFileKind& kind) {
  std::string content = read_input_file(file, kind);
  if (content.find('\0') != std::string::npos) {
    throw Error({file.string(), "binary data", kind.name});
  }
  return content;
}

void require_utf8(const fs::path& file, std::string_view text) {
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t size = utf8_size(text.substr(at));
    if (size == 0) {
      const auto line =
          std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      throw Error({file.string() + ":" + std::to_string(line + 1), "bytes that are not UTF-8",
                   "text in UTF-8", "convert it, for example with iconv"});
    }
    at += size;
  }
}

std::string nearest_file(const fs::path& path) {
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::vector<std::string> names;
  std::error_code error;  // an unreadable folder has no suggestions
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());  // the order of folder entries depends on the file system
  return closest_match(path.filename().string(), names);
}

}  // namespace glidar
