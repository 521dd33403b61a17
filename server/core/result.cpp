#include <spindrift/core/result.h>

namespace spindrift::core {

int exitCode(ErrorCode code) {
  switch (code) {
    case ErrorCode::kInvalidInput:
    case ErrorCode::kUnavailable:
      return 2;
    case ErrorCode::kNoDevice:
      return 3;
    case ErrorCode::kCheckFailed:
    case ErrorCode::kInternal:
      return 1;
  }
  return 1;
}

}  // namespace spindrift::core
