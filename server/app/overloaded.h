// One visitor out of several lambdas, for std::visit.
#pragma once

namespace spindrift::app {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace spindrift::app
