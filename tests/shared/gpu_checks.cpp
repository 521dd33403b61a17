// Linked into every test that makes OpenGL contexts: the test and the programs that it starts run under the barrier
// checker of server/gpu. A missing barrier fails the test (Context::takeFaults()), or ends the process.
// SPINDRIFT_GPU_CHECKS in the environment overrides this, for example "barriers,shuffle=3", or "" for none.
#include <cstdlib>

namespace {

// Runs before main(), because contexts read the variable when they are made.
[[maybe_unused]] const int kSet = setenv("SPINDRIFT_GPU_CHECKS", "barriers", 0);

}  // namespace
