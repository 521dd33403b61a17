// Private to this module.
#pragma once

#include <glad/gl.h>

namespace spindrift::gpu {

/// Empties OpenGL's list of errors, so that the next glGetError() is about the next call. Bounded: a context whose
/// device was lost may report an error for ever.
inline void clearOldErrors() {
  constexpr int kMaxErrors = 32;  // OpenGL keeps one flag per kind of error, and there are eight kinds
  for (int i = 0; i < kMaxErrors && glGetError() != GL_NO_ERROR; ++i) {
  }
}

}  // namespace spindrift::gpu
