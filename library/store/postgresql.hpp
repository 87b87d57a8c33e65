#pragma once

#include <libpq-fe.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "wale/result.hpp"

namespace wale {

/// What a statement gave, row by row, as text. NULL is the empty text.
class Rows {
 public:
  explicit Rows(PGresult* result) : result_(result) {}
  std::size_t size() const { return static_cast<std::size_t>(PQntuples(result_.get())); }
  std::string_view text(std::size_t row, int column) const;
  std::int64_t number(std::size_t row, int column) const;  ///< 0 for what is none

 private:
  struct Clear {
    void operator()(PGresult* result) const { PQclear(result); }
  };
  std::unique_ptr<PGresult, Clear> result_;
};

/// A connection to a database of PostgreSQL. Names without a schema are those of the system, whatever others put into the
/// database. Nothing that it says has the password. Safe from one thread at a time.
class SharedDatabase {
 public:
  /// Connects; waits ten seconds at most, unless the address says otherwise. Errors: W0801 for what is no such address,
  /// W0501 if the database does not answer, refuses, or does not keep its texts in UTF-8.
  static Result<SharedDatabase> open(const std::string& address);

  /// Runs one statement of this program, never a user's text, with values for $1, $2 and so on. What a value has that the
  /// database cannot hold, NUL and bytes that are no UTF-8, becomes U+FFFD. Errors: W0501, W0505 and W0506.
  Result<Rows> ask(const char* sql, const std::vector<std::string>& values = {}) const;
  /// The same for one that gives no rows.
  Result<> run(const char* sql, const std::vector<std::string>& values = {}) const;
  /// Runs several statements without values.
  Result<> run_all(const std::string& sql) const;

  /// Does `work` in one transaction: all of it or nothing. If the database asks for it, since others were in the way, or the
  /// connection is lost, it is done again, some times; so it must be of the kind that can be.
  Result<> in_transaction(const std::function<Result<>()>& work) const;

  /// Whether the last statement that failed did so since this user may not do that.
  bool was_forbidden() const { return last_state_ == "42501"; }
  /// The address without the password.
  const std::string& name() const { return name_; }

 private:
  Error trouble(const PGresult* result) const;
  std::string without_secrets(std::string text) const;
  /// Connects again.
  Result<> reconnect() const;
  Result<> prepare_session() const;

  struct Finish {
    void operator()(PGconn* connection) const { PQfinish(connection); }
  };
  std::unique_ptr<PGconn, Finish> connection_;
  std::string name_;
  std::vector<std::string> secrets_;
  mutable std::string last_state_;  ///< SQLSTATE of the last error
};

/// An array of texts, or of bytes given as hexadecimal digits, as PostgreSQL reads one from a text.
std::string array_of_texts(const std::vector<std::string>& texts);
std::string array_of_numbers(const std::vector<std::int64_t>& numbers);

}  // namespace wale
