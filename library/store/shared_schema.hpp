#pragma once

#include "library/store/postgresql.hpp"

namespace wale {

/// Looks whether a database has the tables of a shared index as this Wale knows them. If `makes`, makes them where there are
/// none, and brings older ones to this version, each step whole or not at all, while other processes that would do the same
/// wait. Errors: W0506 where there are none, or of an older version that this user may not change, W0507 for a newer one,
/// and those of the database.
Result<> prepare_shared_schema(const SharedDatabase& database, bool makes);

}  // namespace wale
