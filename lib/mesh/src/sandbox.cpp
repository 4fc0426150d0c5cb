// A filter of system calls [man 2 seccomp]. It lists what is allowed, not what is forbidden: a call that a later kernel brings is
// refused as well.
#include "sandbox.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/sched.h>
#include <linux/seccomp.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace mortise::mesh {

#if defined(__x86_64__) || defined(__aarch64__)

namespace {

#if defined(__x86_64__)
constexpr std::uint32_t architecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t architecture = AUDIT_ARCH_AARCH64;
#endif

// Reading, memory, time, threads, the end.
const std::vector<std::uint32_t> allowed
{
  SYS_read, SYS_readv, SYS_pread64, SYS_write, SYS_writev, SYS_lseek, SYS_close, SYS_fstat, SYS_newfstatat, SYS_statx, SYS_statfs,
      SYS_fstatfs, SYS_faccessat, SYS_faccessat2, SYS_readlinkat, SYS_getcwd, SYS_getdents64, SYS_fadvise64, SYS_fcntl, SYS_dup,
      SYS_mmap, SYS_munmap, SYS_mremap, SYS_mprotect, SYS_madvise, SYS_brk, SYS_futex, SYS_rt_sigaction, SYS_rt_sigprocmask,
      SYS_rt_sigreturn, SYS_sigaltstack, SYS_getpid, SYS_gettid, SYS_getppid, SYS_exit, SYS_exit_group, SYS_clock_gettime,
      SYS_clock_getres, SYS_clock_nanosleep, SYS_nanosleep, SYS_gettimeofday, SYS_times, SYS_getrusage, SYS_sysinfo, SYS_uname,
      SYS_sched_yield, SYS_sched_getaffinity, SYS_getrandom, SYS_set_robust_list, SYS_set_tid_address, SYS_restart_syscall,
      SYS_getuid, SYS_geteuid, SYS_getgid, SYS_getegid, SYS_membarrier, SYS_ppoll,
#ifdef SYS_rseq
      SYS_rseq,
#endif
#if defined(__x86_64__)
      SYS_stat, SYS_lstat, SYS_access, SYS_readlink, SYS_time, SYS_getrlimit, SYS_poll, SYS_arch_prctl,
#endif
};

// What a script of gmsh can ask for: it ends the process, so that nobody takes a mesh for whole that lacks a program's part.
const std::vector<std::uint32_t> reported
{
  SYS_execve, SYS_execveat, SYS_unlinkat, SYS_renameat, SYS_renameat2, SYS_mkdirat, SYS_linkat, SYS_symlinkat, SYS_mknodat,
      SYS_truncate, SYS_fchmodat, SYS_fchownat, SYS_socket,
#if defined(__x86_64__)
      SYS_fork, SYS_vfork, SYS_unlink, SYS_rename, SYS_mkdir, SYS_rmdir, SYS_link, SYS_symlink, SYS_mknod, SYS_creat, SYS_chmod,
      SYS_chown,
#endif
};

constexpr std::uint32_t trap = SECCOMP_RET_TRAP, allow = SECCOMP_RET_ALLOW, absent = SECCOMP_RET_ERRNO | ENOSYS;

// A programme for the kernel's filter: instructions that look at the number of a call and at the low halves of its arguments.
class Filter {
 public:
  Filter()
  {
    load(offsetof(seccomp_data, arch));
    give_unless(architecture, SECCOMP_RET_KILL_PROCESS);
    load(offsetof(seccomp_data, nr));
  }
  void give_if(std::uint32_t value, std::uint32_t verdict) { add(BPF_JMP | BPF_JEQ | BPF_K, value, 0, 1), give(verdict); }
  void give_unless(std::uint32_t value, std::uint32_t verdict) { add(BPF_JMP | BPF_JEQ | BPF_K, value, 1, 0), give(verdict); }
  // Of this call: `one` if any of the bits of an argument is set, else `none`.
  void give_by_bits(std::uint32_t call, int argument, std::uint32_t bits, std::uint32_t one, std::uint32_t none)
  {
    begin_call(call, 4);
    load_argument(argument);
    add(BPF_JMP | BPF_JSET | BPF_K, bits, 0, 1), give(one), give(none);
  }
  // Of this call: allowed if an argument has this value.
  void allow_if(std::uint32_t call, int argument, std::uint32_t value)
  {
    begin_call(call, 4);
    load_argument(argument);
    give_if(value, allow), give(absent);
  }
  void give(std::uint32_t verdict) { add(BPF_RET | BPF_K, verdict, 0, 0); }
  bool install()
  {
    const sock_fprog program{static_cast<unsigned short>(code_.size()), code_.data()};
    return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
  }

 private:
  void add(unsigned code, std::uint32_t k, unsigned char yes, unsigned char no)
  {
    code_.push_back({static_cast<unsigned short>(code), yes, no, k});
  }
  void load(std::size_t offset) { add(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset), 0, 0); }
  void load_argument(int argument) { load(offsetof(seccomp_data, args) + 8 * static_cast<std::size_t>(argument)); }
  // The `length` instructions that follow are of this call alone.
  void begin_call(std::uint32_t call, unsigned char length) { add(BPF_JMP | BPF_JEQ | BPF_K, call, 0, length); }
  std::vector<sock_filter> code_;
};

void (*tell)(const char*) = nullptr;

void refused(int, siginfo_t* info, void*)
{
  const auto call = info->si_syscall;
  bool program = call == SYS_execve || call == SYS_execveat || call == SYS_clone;
#if defined(__x86_64__)
  program = program || call == SYS_fork || call == SYS_vfork;
#endif
  tell(program ? "start a program" : call == SYS_socket ? "open a connection" : "write, move or remove a file");
  _exit(0);
}

}  // namespace

bool confine(void (*told)(const char* what))
{
  tell = told;
  struct sigaction action = {};
  action.sa_sigaction = refused;
  action.sa_flags = SA_SIGINFO;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  constexpr std::uint32_t writing = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC | O_APPEND;
  Filter filter;
#if defined(__x86_64__)
  filter.give_by_bits(SYS_open, 1, writing, trap, allow);
#endif
  filter.give_by_bits(SYS_openat, 2, writing, trap, allow);
  filter.give_by_bits(SYS_clone, 0, CLONE_THREAD, allow, trap);
  filter.allow_if(SYS_ioctl, 1, TCGETS);
  filter.allow_if(SYS_prlimit64, 0, 0);  // only its own
  filter.allow_if(SYS_tgkill, 0, static_cast<std::uint32_t>(getpid()));
  for (const auto call : reported) filter.give_if(call, trap);
  for (const auto call : allowed) filter.give_if(call, allow);
  filter.give(absent);
  return filter.install();
}

#else

bool confine(void (*)(const char*))
{
  return false;
}

#endif

}  // namespace mortise::mesh
