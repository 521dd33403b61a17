// Lets the headers in this folder compile as C++ and as GLSL. Shared blocks contain only scalars of four bytes, so that
// std140 and C++ agree on every offset.
#ifndef SPINDRIFT_SHARED_DUAL_H
#define SPINDRIFT_SHARED_DUAL_H

#ifdef __cplusplus
#include <cstdint>
namespace spindrift::shared {
using uint = std::uint32_t;
}
#endif

#endif
