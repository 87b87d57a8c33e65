#pragma once

#include <boost/math/policies/policy.hpp>

namespace wale {

/// Boost's distributions in double. By default they compute in long double, and do so once before main to fill their
/// tables; where long double is no longer than double, as under valgrind, that ends the process.
using InDouble = boost::math::policies::policy<boost::math::policies::promote_float<false>,
                                               boost::math::policies::promote_double<false>>;

}  // namespace wale
