#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "wale/result.hpp"

namespace wale {

/// A database of SQLite in a file. Safe from one thread at a time.
class Database {
 public:
  /// Opens a file, and makes it if `makes`. Errors: W0501 and W0505 where that fails, W0506 for another file.
  static Result<Database> open(const std::string& path, bool makes);

  /// One statement, prepared anew.
  class Statement {
   public:
    Statement& bind(std::int64_t number);
    Statement& bind(std::string_view text);  ///< must live until the statement has run
    /// Goes to the next row. False behind the last, and after an error, which `trouble` has.
    bool step();
    /// Runs it to its end, and makes it ready for other values.
    Result<> run();
    std::int64_t number(int column) const { return sqlite3_column_int64(statement_.get(), column); }
    std::string_view text(int column) const;
    Result<> trouble() const;

   private:
    friend class Database;
    struct Finalize {
      void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    };
    const Database* database_ = nullptr;
    std::unique_ptr<sqlite3_stmt, Finalize> statement_;
    int bound_ = 0, last_ = SQLITE_OK;
  };

  /// `sql` is one statement of this program, never a user's text.
  Statement prepare(const char* sql) const;
  /// Runs statements without values.
  Result<> execute(const char* sql) const;
  /// The first number of the first row; 0 without one.
  std::int64_t number(const char* sql) const;
  /// What SQLite says went wrong, as an error about the file.
  Error trouble(int status) const;
  const std::string& path() const { return path_; }

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
  };
  std::string path_;
  std::unique_ptr<sqlite3, Close> database_;
};

}  // namespace wale
