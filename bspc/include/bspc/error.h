#pragma once

#include <stdexcept>
#include <string>

namespace bspc {

/// What kind of thing went wrong. Values are stable: callers may switch on them.
enum class ErrorCode {
  InvalidArgument = 1,  ///< the caller asked for something contradictory or out of range
  NonFinite = 2,        ///< a coordinate is NaN or infinite
  OutOfGrid = 3,        ///< a coordinate does not fit into the grid that was asked for
  Unsupported = 4,      ///< valid, but this version cannot do it (method, version, required block)
  NotBspc = 5,          ///< the signature is missing: not a .bspc file
  Truncated = 6,        ///< the file ends early
  Corrupt = 7,          ///< a checksum or a rule of the format is violated
  LimitExceeded = 8,    ///< a DecodeLimits bound was reached
  Cancelled = 9,        ///< the progress callback asked to stop
  Io = 10,              ///< a source or a sink failed
};

/// The name of a code as printed to people, e.g. "truncated".
const char* errorCodeName(ErrorCode code);

/// The only exception type that leaves the library on purpose (std::bad_alloc may pass through).
/// what() is one sentence: what is wrong, where, and what to do about it.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace bspc
