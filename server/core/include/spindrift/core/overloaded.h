// Combines several lambdas into one visitor for std::visit.
#pragma once

namespace spindrift::core {

template <class... F>
struct Overloaded : F... {
  using F::operator()...;
};
template <class... F>
Overloaded(F...) -> Overloaded<F...>;

}  // namespace spindrift::core
