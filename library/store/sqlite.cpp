#include "library/store/sqlite.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace wale {

Result<Database> Database::open(const std::string& path, bool makes) {
  // SQLite waits at a pipe for ever.
  std::error_code failed;
  const auto kind = std::filesystem::status(path, failed).type();
  if (kind != std::filesystem::file_type::regular && kind != std::filesystem::file_type::not_found &&
      kind != std::filesystem::file_type::none)
    return Error{.code = Code::unreadable_file,
                 .sentence = "the index cannot be opened: it is no regular file",
                 .mend = "`wale library index -o FILE` makes one",
                 .place = {.name = path}};
  Database made;
  made.path_ = path;
  sqlite3* opened = nullptr;
  const int flags = SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX | (makes ? SQLITE_OPEN_CREATE : 0);
  int status = sqlite3_open_v2(path.c_str(), &opened, flags, nullptr);
  made.database_.reset(opened);
  if (status != SQLITE_OK && !makes) {  // a folder that may only be read
    status = sqlite3_open_v2(path.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, nullptr);
    made.database_.reset(opened);
  }
  if (status != SQLITE_OK) return made.trouble(status);
  // Another process that writes is waited for.
  constexpr int most_milliseconds = 10'000;
  sqlite3_busy_timeout(opened, most_milliseconds);
  sqlite3_extended_result_codes(opened, 1);
  // A file that somebody else wrote cannot make this program run functions of its own.
  sqlite3_db_config(opened, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  if (const auto looked = made.execute("SELECT count(*) FROM sqlite_schema"); !looked) return looked.error();
  return made;
}

Error Database::trouble(int status) const {
  const char* said = database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(status);
  const int kind = status & 0xff;
  if (kind == SQLITE_NOTADB || kind == SQLITE_CORRUPT)
    return {.code = Code::damaged_file,
            .sentence = fmt::format("this is no index, or a damaged one: {}", said),
            .mend = "name another file, or make one: `wale library index -o FILE`",
            .place = {.name = path_}};
  const bool writes = kind == SQLITE_READONLY || kind == SQLITE_FULL || kind == SQLITE_IOERR;
  return {.code = writes ? Code::unwritable_file : Code::unreadable_file,
          .sentence = fmt::format("the index cannot be {}: {}", writes ? "written" : "opened", said),
          .mend = kind == SQLITE_BUSY ? "another process writes it; try again when that has ended"
                   : writes           ? "name a file in a folder that you may write"
                                      : "make one: `wale library index -o FILE`",
          .place = {.name = path_}};
}

Database::Statement Database::prepare(const char* sql) const {
  Statement made;
  made.database_ = this;
  sqlite3_stmt* prepared = nullptr;
  made.last_ = sqlite3_prepare_v2(database_.get(), sql, -1, &prepared, nullptr);
  made.statement_.reset(prepared);
  return made;
}

Result<> Database::execute(const char* sql) const {
  const int status = sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr);
  return status == SQLITE_OK ? Result<>() : Result<>(trouble(status));
}

std::int64_t Database::number(const char* sql) const {
  Statement statement = prepare(sql);
  return statement.step() ? statement.number(0) : 0;
}

Database::Statement& Database::Statement::bind(std::int64_t number) {
  if (statement_) sqlite3_bind_int64(statement_.get(), ++bound_, number);
  return *this;
}

Database::Statement& Database::Statement::bind(std::string_view text) {
  if (text.data() == nullptr) text = "";  // which is not NULL
  if (statement_)
    sqlite3_bind_text64(statement_.get(), ++bound_, text.data(), text.size(), SQLITE_STATIC, SQLITE_UTF8);
  return *this;
}

bool Database::Statement::step() {
  if (!statement_) return false;
  last_ = sqlite3_step(statement_.get());
  return last_ == SQLITE_ROW;
}

Result<> Database::Statement::run() {
  while (step()) {
  }
  const auto came = trouble();
  if (statement_) sqlite3_reset(statement_.get());
  bound_ = 0;
  return came;
}

std::string_view Database::Statement::text(int column) const {
  const auto* begin = reinterpret_cast<const char*>(sqlite3_column_text(statement_.get(), column));
  return begin ? std::string_view(begin, static_cast<std::size_t>(sqlite3_column_bytes(statement_.get(), column)))
               : std::string_view();
}

Result<> Database::Statement::trouble() const {
  const bool good = last_ == SQLITE_OK || last_ == SQLITE_ROW || last_ == SQLITE_DONE;
  return good ? Result<>() : Result<>(database_->trouble(last_));
}

}  // namespace wale
