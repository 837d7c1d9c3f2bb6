#include "bspc/error.h"

namespace bspc {

const char* errorCodeName(ErrorCode code) {
  switch (code) {
    case ErrorCode::InvalidArgument:
      return "invalid argument";
    case ErrorCode::NonFinite:
      return "non-finite coordinate";
    case ErrorCode::OutOfGrid:
      return "out of grid";
    case ErrorCode::Unsupported:
      return "unsupported";
    case ErrorCode::NotBspc:
      return "not a .bspc file";
    case ErrorCode::Truncated:
      return "truncated";
    case ErrorCode::Corrupt:
      return "corrupt";
    case ErrorCode::LimitExceeded:
      return "limit exceeded";
    case ErrorCode::Cancelled:
      return "cancelled";
    case ErrorCode::Io:
      return "input/output";
  }
  return "unknown";
}

}  // namespace bspc
