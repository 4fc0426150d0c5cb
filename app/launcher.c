/* mortise: starts mortise-solver, the program proper, which stands beside it.
 *
 * The solver's libraries take some 250 MB of address space. Where that is limited (ulimit -v, batch systems), the system's loader may
 * fail before a line of the solver's own runs, with an exit status that promises nothing. So this small program has the loader try
 * first, and then becomes the solver: same process, same arguments. Signals wait until the solver is there to handle them. */
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

static const int machine = 4; /* ExitStatus::machine */

/* What the solver handles, it is told only when it can: while the loader is at work the default would end it. */
static void hold_signals(void)
{
  static const int held[] = {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGXCPU, SIGABRT, SIGSEGV, SIGBUS, SIGFPE};
  sigset_t set;
  sigemptyset(&set);
  for (size_t i = 0; i < sizeof held / sizeof *held; ++i) sigaddset(&set, held[i]);
  sigprocmask(SIG_BLOCK, &set, NULL);
}

static int is_limited(int resource)
{
  struct rlimit limit;
  return getrlimit(resource, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY;
}

/* Whether the loader finds room for all libraries; it loads them and stops. */
static int loads(const char* program)
{
  const pid_t child = fork();
  if (child == 0) {
    const int nowhere = open("/dev/null", O_RDWR);
    dup2(nowhere, STDOUT_FILENO);
    dup2(nowhere, STDERR_FILENO);
    setenv("LD_TRACE_LOADED_OBJECTS", "1", 1);
    execl(program, program, (char*)NULL);
    _exit(127);
  }
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  return child > 0 && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* OpenBLAS tells processors by their names. Those that came after it (2022, in Debian 12) get code from before AVX, which takes up to
 * three times as long. One choice for all that can do AVX2 also gives them all the same rounding. */
static void choose_blas_kernels(void)
{
#ifdef __x86_64__
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) setenv("OPENBLAS_CORETYPE", "Haswell", 0);
#endif
}

int main(int argc, char** argv)
{
  (void)argc;
  hold_signals();
  static const char name[] = "mortise-solver";
  static char program[4096];
  const ssize_t length = readlink("/proc/self/exe", program, sizeof program - sizeof name);
  if (length > 0) strcpy(strrchr(program, '/') + 1, name);
  if (length <= 0 || access(program, X_OK) != 0) {
    fprintf(stderr, "mortise: %s: cannot be started: %s; it belongs beside mortise\n", program, strerror(errno));
    return machine;
  }
  if ((is_limited(RLIMIT_AS) || is_limited(RLIMIT_DATA)) && !loads(program)) {
    fputs("mortise: out of memory: there is no room even for the program's libraries, which take some 250 MB of address space; raise the "
          "limit of memory (ulimit -v)\n",
          stderr);
    return machine;
  }
  /* Without mpirun, Open MPI would start a daemon for one process, and look for networks: 0.4 s of every run. */
  setenv("OMPI_MCA_ess_singleton_isolated", "1", 0);
  if (getenv("OMPI_COMM_WORLD_SIZE") == NULL && getenv("PMIX_RANK") == NULL) setenv("OMPI_MCA_pml", "ob1", 0);
  choose_blas_kernels();
  execv(program, argv);
  fprintf(stderr, "mortise: %s: cannot be started: %s\n", program, strerror(errno));
  return machine;
}
