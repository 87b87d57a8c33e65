#pragma once

#include <atomic>
#include <future>
#include <memory>

#include "schema/home_process.hpp"
#include "wale/library.h"
#include "wale/library.hpp"

struct WaleLibrary {
  wale::Library library;
  std::vector<wale::DeclaredDevice> devices = library.devices();
};

namespace wale::c {

/// How far a search is, and whether it is to end.
struct SearchState {
  std::atomic<std::size_t> done = 0, all = 0;
  std::atomic<bool> ends = false;
};

}  // namespace wale::c

/// Of a program or of a search.
struct WaleFuture {
  std::future<wale::Result<wale::Compiled>> program = {};
  std::future<wale::Result<wale::SearchResult>> matches = {};
  std::shared_ptr<wale::c::SearchState> state = {};  ///< null for a program
  wale::HomeProcess home = {};

  bool is_valid() const { return program.valid() || matches.valid(); }
};

namespace wale::c {

/// Errors: it is NULL, was taken, is of another process, or of another kind: of a search or not.
Result<> is_to_take(const WaleFuture* future, bool of_search);

}  // namespace wale::c
