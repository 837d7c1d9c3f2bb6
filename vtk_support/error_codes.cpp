#include "vtk_support/error_codes.h"

#include <vtkErrorCode.h>

namespace bspc::vtk {

unsigned long vtkErrorCodeOf(ErrorCode code) {
  switch (code) {
    case ErrorCode::NotBspc:
      return vtkErrorCode::UnrecognizedFileTypeError;
    case ErrorCode::Truncated:
      return vtkErrorCode::PrematureEndOfFileError;
    case ErrorCode::Corrupt:
    case ErrorCode::LimitExceeded:
    case ErrorCode::Unsupported:
      return vtkErrorCode::FileFormatError;
    case ErrorCode::Io:
      return vtkErrorCode::CannotOpenFileError;
    case ErrorCode::InvalidArgument:
    case ErrorCode::NonFinite:
    case ErrorCode::OutOfGrid:
    case ErrorCode::Cancelled:
      return vtkErrorCode::UnknownError;
  }
  return vtkErrorCode::UnknownError;
}

}  // namespace bspc::vtk
