#pragma once

namespace wale {

/// Whether this machine has vectors of four doubles.
inline bool has_four_doubles() {
#if defined(__x86_64__)
  static const bool has = __builtin_cpu_supports("avx2") != 0;
  return has;
#else
  return false;
#endif
}

#if defined(__x86_64__)
template <typename Kernel, typename... Arguments>
[[gnu::target("avx2")]] auto run_with_four_doubles(Arguments... arguments) {
  return Kernel::run(arguments...);
}
#endif

/// Calls `Kernel::run`, which is always inlined, as it is compiled for the vectors of this machine. Wider vectors do
/// the same operations in the same order, without fused ones, so the result has the same bits everywhere.
template <typename Kernel, typename... Arguments>
auto run_wide(Arguments... arguments) {
#if defined(__x86_64__)
  if (has_four_doubles()) return run_with_four_doubles<Kernel>(arguments...);
#endif
  return Kernel::run(arguments...);
}

}  // namespace wale
