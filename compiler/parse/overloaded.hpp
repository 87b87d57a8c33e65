#pragma once

namespace wale {

/// One function out of several lambdas, one for each alternative of a variant: for `std::visit`.
template <typename... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <typename... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

}  // namespace wale
