// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause

// glidar_sandbox_probe MODEL CREASE_ANGLE_RAD MEMORY_BYTES TIME_S PARENT
// Replaces glidar-import as if a hostile model had taken control of it: it enters the same sandbox,
// attempts forbidden actions, and prints the result of each attempt: "NAME: 0" when it succeeded,
// else the name of the error. The first line of MODEL is a file outside the model's
// folder, the second a TCP port of this machine on which a test listens, the third, if any, the
// newest version of Landlock's interface to use.

#include <import/process_limits.hpp>
#include <import/sandbox.hpp>

#include <glidar/io/model/mesh_blob.hpp>
#include <glidar/io/model/model_folder.hpp>

#include <arpa/inet.h>
#include <dirent.h>
#include <fcntl.h>
#include <linux/openat2.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

extern char** environ;

namespace glidar::import {
namespace {

constexpr int kLastFd = 4;

struct Attempts {
  std::filesystem::path model;
  std::string outside;
  std::uint16_t port = 0;
  pid_t parent = 0;
  long newest_landlock = kNewestLandlock;
  std::string report;

  /// `result`: negative when it failed, with errno.
  void add(const char* name, long result) {
    report += std::string(name) + ": " + (result >= 0 ? "0" : ::strerrorname_np(errno)) + "|";
  }
};

long open2(const std::string& path, std::uint64_t flags) {
  open_how how{};
  how.flags = flags;
  how.mode = (flags & O_CREAT) != 0U ? 0600 : 0;
  return ::syscall(SYS_openat2, AT_FDCWD, path.c_str(), &how, sizeof how);
}

void read_files(Attempts& t) {
  const std::string folder = t.model.parent_path().string();
  t.add("have a descriptor of the parent", ::fcntl(kLastFd + 1, F_GETFD));
  t.add("read the model again", ::open(t.model.c_str(), O_RDONLY));
  t.add("read a file outside", ::open(t.outside.c_str(), O_RDONLY));
  t.add("read a file outside by openat2", open2(t.outside, O_RDONLY));
  t.add("read a file outside by a link", ::open((folder + "/link").c_str(), O_RDONLY));
  t.add("read the users", ::open("/etc/passwd", O_RDONLY));
  t.add("read the memory of the parent",
        ::open(("/proc/" + std::to_string(t.parent) + "/mem").c_str(), O_RDONLY));
  t.add("list the root folder", ::open("/", O_RDONLY | O_DIRECTORY));
  t.add("list the folder outside",
        ::opendir(std::filesystem::path(t.outside).parent_path().c_str()) == nullptr ? -1 : 0);
}

void change_files(Attempts& t) {
  const std::string model = t.model.string();
  const std::string other = model + ".new";
  t.add("write the model", ::open(model.c_str(), O_WRONLY));
  t.add("write the model by openat2", open2(model, O_WRONLY));
  t.add("write a file outside", ::open(t.outside.c_str(), O_RDWR));
  t.add("truncate the model by openat2", open2(model, O_RDONLY | O_TRUNC));
  t.add("create a file", ::open(other.c_str(), O_WRONLY | O_CREAT, 0600));
  t.add("create a file by openat2", open2(other, O_WRONLY | O_CREAT));
  t.add("create a file by creat", ::creat(other.c_str(), 0600));
  t.add("create an unnamed file", ::open(t.model.parent_path().c_str(), O_TMPFILE | O_RDWR, 0600));
  t.add("truncate a file", ::truncate(model.c_str(), 0));
  t.add("remove a file", ::unlink(model.c_str()));
  t.add("rename a file", ::rename(model.c_str(), other.c_str()));
  t.add("link a file", ::link(model.c_str(), other.c_str()));
  t.add("make a symbolic link", ::symlink("/", other.c_str()));
  t.add("make a folder", ::mkdir(other.c_str(), 0700));
  t.add("make a pipe", ::mknod(other.c_str(), S_IFIFO | 0600, 0));
  t.add("change permissions", ::chmod(model.c_str(), 0777));
  t.add("change the owner", ::chown(model.c_str(), 1, 1));
  t.add("change times", ::utimensat(AT_FDCWD, model.c_str(), nullptr, 0));
}

void reach_the_network(Attempts& t) {
  const int tcp = ::socket(AF_INET, SOCK_STREAM, 0);
  t.add("make a TCP socket", tcp);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(t.port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  t.add("connect", ::connect(tcp, reinterpret_cast<sockaddr*>(&address), sizeof address));
  t.add("make a UDP socket", ::socket(AF_INET6, SOCK_DGRAM, 0));
  t.add("make a UNIX socket", ::socket(AF_UNIX, SOCK_STREAM, 0));
  std::array<int, 2> pair{};
  t.add("make a pair of sockets", ::socketpair(AF_UNIX, SOCK_STREAM, 0, pair.data()));
  t.add("use io_uring", ::syscall(SYS_io_uring_setup, 1, nullptr));
}

void start_programs(Attempts& t) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(0);
  t.add("fork", child);
  const long raw = ::syscall(SYS_clone, SIGCHLD, nullptr, nullptr, nullptr, nullptr);
  if (raw == 0) ::_exit(0);
  t.add("clone", raw);
  t.add("clone3", ::syscall(SYS_clone3, nullptr, 0));
  pthread_t thread{};
  errno = ::pthread_create(
      &thread, nullptr, [](void*) -> void* { return nullptr; }, nullptr);
  t.add("start a thread", errno == 0 ? 0 : -1);
  char program[] = "/bin/true";
  std::array<char*, 2> arguments = {program, nullptr};
  t.add("execute a program", ::execv(program, arguments.data()));
  t.add("execute by execveat",
        ::syscall(SYS_execveat, AT_FDCWD, program, arguments.data(), environ, 0));
}

void attack_processes(Attempts& t) {
  t.add("signal the parent", ::kill(t.parent, 0));
  t.add("kill the parent", ::kill(t.parent, SIGCONT));
  t.add("kill a thread of the parent", ::syscall(SYS_tgkill, t.parent, t.parent, SIGCONT));
  t.add("kill all", ::kill(-1, 0));
  t.add("trace the parent", ::ptrace(PTRACE_ATTACH, t.parent, nullptr, nullptr));
  std::array<char, 8> bytes{};
  iovec here{bytes.data(), bytes.size()};
  iovec there{bytes.data(), bytes.size()};
  t.add("read the parent's memory", ::process_vm_readv(t.parent, &here, 1, &there, 1, 0));
  t.add("write the parent's memory", ::process_vm_writev(t.parent, &here, 1, &there, 1, 0));
  t.add("open the parent", ::syscall(SYS_pidfd_open, t.parent, 0));
  t.add("slow the parent down", ::setpriority(PRIO_PROCESS, static_cast<id_t>(t.parent), 19));
  rlimit limit{};
  t.add("limit the parent", ::prlimit(t.parent, RLIMIT_CPU, &limit, nullptr));
}

void gain_powers(Attempts& t) {
  t.add("map executable memory", ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC,
                                        MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED
                                     ? -1
                                     : 0);
  void* page = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  t.add("make memory executable", ::mprotect(page, 4096, PROT_READ | PROT_EXEC));
  t.add("map a file's code", ::syscall(SYS_remap_file_pages, page, 4096, PROT_EXEC, 0, 0));
  t.add("become another user", ::setuid(0));
  t.add("make a namespace", ::unshare(CLONE_NEWUSER));
  t.add("change the root", ::chroot("/"));
  t.add("mount", ::mount("none", "/", nullptr, MS_REMOUNT, nullptr));
  t.add("change the process", ::prctl(PR_SET_PDEATHSIG, 0));
  const rlimit unlimited{RLIM_INFINITY, RLIM_INFINITY};
  t.add("raise a limit", ::setrlimit(RLIMIT_NOFILE, &unlimited));
  t.add("load a kernel program", ::syscall(SYS_bpf, 0, nullptr, 0));
  t.add("use the keyring", ::syscall(SYS_keyctl, 0, 0, 0, 0, 0));
  t.add("handle page faults", ::syscall(SYS_userfaultfd, 0));
  t.add("watch the processor", ::syscall(SYS_perf_event_open, nullptr, 0, -1, -1, 0));
  t.add("duplicate a descriptor", ::dup(0));
  t.add("make a memory file", ::memfd_create("x", 0));
  errno = ENOENT;
  constexpr std::string_view kOwn =
      "GLIBC_TUNABLES=glibc.cpu.hwcaps=-FMA,-FMA4";  // the same for all
  bool has_others = false;
  for (char** variable = environ; variable != nullptr && *variable != nullptr; ++variable) {
    if (*variable != kOwn) has_others = true;
  }
  t.add("read a variable of the environment", has_others ? 0 : -1);
}

void attempt_all(Attempts& attempts) {
  read_files(attempts);
  change_files(attempts);
  reach_the_network(attempts);
  start_programs(attempts);
  attack_processes(attempts);
  gain_powers(attempts);
}

Attempts plan(const std::filesystem::path& model, pid_t parent) {
  Attempts attempts;
  attempts.model = model;
  attempts.parent = parent;
  std::ifstream file(model);
  std::getline(file, attempts.outside);
  file >> attempts.port;
  if (long newest = 0; file >> newest) attempts.newest_landlock = newest;
  return attempts;
}

int run(const char* const* argv) {
  const ProcessLimits limits{std::strtoull(argv[3], nullptr, 10), std::strtod(argv[4], nullptr),
                             std::strtoll(argv[5], nullptr, 10)};
  if (!apply(limits)) return 2;
  Attempts attempts = plan(argv[1], static_cast<pid_t>(limits.parent));
  for (const std::string& note :
       enter_sandbox(model_folder(argv[1]).allowed(), kLastFd, attempts.newest_landlock)) {
    attempts.report += "note: " + note + "|";
  }
  // Without its sandbox it would succeed in some.
  if (attempts.report.empty()) attempt_all(attempts);
  write_failure(3, {attempts.report, ""});
  return 0;
}

}  // namespace
}  // namespace glidar::import

int main(int argc, char** argv) {
  constexpr int kArguments = 6;
  ::_exit(argc == kArguments ? glidar::import::run(argv) : 2);
}
