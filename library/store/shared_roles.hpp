#pragma once

#include <string>

namespace wale {

/// The SQL that gives the tables of a shared index to three roles, each of which may no more than it needs: `wale_reader`
/// finds; `wale_curator` also gives and takes materials; `wale_owner` has the tables, and makes those of a newer Wale. The
/// roles cannot log in: persons are made members, GRANT wale_reader TO anna. It can be run again. It needs a user who may
/// make roles and owns the tables.
std::string roles_of_shared_index();

/// The part of it that a new version of the tables needs, where the roles are there.
std::string grants_of_shared_index();

}  // namespace wale
