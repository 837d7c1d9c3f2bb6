#include "cli/interrupts.h"

#include <unistd.h>

#include <array>
#include <climits>
#include <csignal>

namespace bspc::cli {

namespace {

volatile std::sig_atomic_t interruptSeen = 0;

/// A handler may touch no std::string: the path lies in plain memory, which is changed only while
/// `hasUnfinished` is 0.
std::array<char, PATH_MAX> unfinished{};
volatile std::sig_atomic_t hasUnfinished = 0;

void noteInterrupt(int signal) {
  if (interruptSeen == 0) {
    interruptSeen = 1;
    return;
  }
  if (hasUnfinished != 0) ::unlink(unfinished.data());
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

void catchInterrupts() {
  std::signal(SIGINT, noteInterrupt);
  std::signal(SIGTERM, noteInterrupt);
  // nohup has it ignored.
  if (std::signal(SIGHUP, noteInterrupt) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);
  // A file that grows beyond what is allowed is then an error of writing.
  std::signal(SIGXFSZ, SIG_IGN);
}

bool interrupted() { return interruptSeen != 0; }

void setUnfinishedFile(const std::string& path) {
  hasUnfinished = 0;
  if (path.empty() || path.size() >= unfinished.size()) return;
  path.copy(unfinished.data(), path.size());
  unfinished[path.size()] = '\0';
  hasUnfinished = 1;
}

}  // namespace bspc::cli
