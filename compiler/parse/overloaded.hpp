#pragma once

namespace wale {

/// Combines several lambdas, one for each alternative of a variant, into one function object for `std::visit`.
template <typename... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <typename... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace wale
