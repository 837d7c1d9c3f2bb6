#pragma once

#include <stdexcept>
#include <string>

namespace bspc::cli {

/// Exit codes of the command, as `bspc --help` documents them.
constexpr int kSuccess = 0;
constexpr int kFailure = 1;
constexpr int kUsage = 2;

/// The command line asks for something that makes no sense; ends the command with kUsage.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace bspc::cli
