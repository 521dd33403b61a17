// Linked into every test that makes OpenGL contexts: they run under the barrier checker of server/gpu, and so do
// programs that the tests start. A missing barrier fails the test that sees it (Context::takeFaults()), or ends the
// process. SPINDRIFT_GPU_CHECKS in the environment of a test run wins, for example "barriers,shuffle=3" or "" for none.
#include <cstdlib>

namespace {

// Before main(), because contexts read the variable when they are made.
[[maybe_unused]] const int kSet = setenv("SPINDRIFT_GPU_CHECKS", "barriers", 0);

}  // namespace
