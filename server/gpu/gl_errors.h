// Private to this module.
#pragma once

#include <glad/gl.h>

namespace spindrift::gpu {

/// Clears OpenGL's error flags, so that the next glGetError() reports only later calls. Bounded, because a context
/// whose device was lost may report an error forever.
inline void clearOldErrors() {
  constexpr int kMaxErrors = 32;  // OpenGL keeps one flag per kind of error, and there are eight kinds
  for (int i = 0; i < kMaxErrors && glGetError() != GL_NO_ERROR; ++i) {
  }
}

}  // namespace spindrift::gpu
