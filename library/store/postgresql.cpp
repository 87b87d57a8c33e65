#include "library/store/postgresql.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <random>
#include <thread>

#include "library/store/library_store.hpp"
#include "schema/utf8.hpp"

namespace wale {
namespace {

constexpr int most_attempts = 12;

/// What the database can hold of a text.
std::string storable(const std::string& text) {
  std::string held;
  std::size_t good = 0;  // so far all bytes are
  for (std::size_t at = 0; at < text.size();) {
    const Character character = decode(text, at);
    if (!character.valid || character.code == 0) {
      held.append(text, good, at - good).append("\xef\xbf\xbd");
      good = at + character.bytes;
    }
    at += character.bytes;
  }
  return good == 0 ? text : held.append(text, good);
}

std::string first_line(std::string text) {
  text.erase(std::min(text.find('\n'), text.size()));
  for (const std::string_view said : {"ERROR:  ", "FATAL:  "})
    if (text.starts_with(said)) text.erase(0, said.size());
  return text;
}

bool begins_with_any(const std::string& state, std::initializer_list<std::string_view> all) {
  return std::ranges::any_of(all, [&](std::string_view each) { return state.starts_with(each); });
}

/// Others were in the way: a serialisation that failed, a deadlock, a lock that was not to be had.
bool may_go_well_again(const std::string& state) { return begins_with_any(state, {"40001", "40P01", "55P03"}); }

std::string mend_of_state(const std::string& state) {
  if (state.starts_with("42501"))
    return "ask the owner of the index for a role that may: `wale library index --roles` prints what gives them";
  if (begins_with_any(state, {"53", "54"})) return "ask who looks after the database, which is short of something";
  if (begins_with_any(state, {"25006"})) return "write to the main server, not to a copy that may only be read";
  return "try again; if it stays so, ask who looks after the database";
}

}  // namespace

std::string_view Rows::text(std::size_t row, int column) const {
  const int at = static_cast<int>(row);
  return {PQgetvalue(result_.get(), at, column), static_cast<std::size_t>(PQgetlength(result_.get(), at, column))};
}

std::int64_t Rows::number(std::size_t row, int column) const {
  return std::strtoll(PQgetvalue(result_.get(), static_cast<int>(row), column), nullptr, 10);
}

Result<SharedDatabase> SharedDatabase::open(const std::string& address) {
  SharedDatabase made;
  made.name_ = without_password(address);
  char* why = nullptr;
  PQconninfoOption* parts = address.find('\0') == std::string::npos ? PQconninfoParse(address.c_str(), &why) : nullptr;
  PQfreemem(why);  // which may quote the password
  if (!parts)
    return Error{.code = Code::malformed_value,
                 .sentence = "this is no address of a database",
                 .mend = "write postgresql://USER@HOST/DATABASE; signs such as @, / and : in a name or password as %40, %2F "
                         "and %3A",
                 .place = {.name = made.name_}};
  for (const PQconninfoOption* each = parts; each->keyword; ++each)
    if (each->val && *each->val && std::string_view(each->keyword).find("password") != std::string_view::npos)
      made.secrets_.emplace_back(each->val);
  PQconninfoFree(parts);
  // Later ones go before earlier ones.
  const char* const names[] = {"connect_timeout", "dbname", "client_encoding", "application_name", nullptr};
  const char* const values[] = {"10", address.c_str(), "UTF8", "wale", nullptr};
  made.connection_.reset(PQconnectdbParams(names, values, 1));
  if (!made.connection_)
    return Error{.code = Code::short_of_resources,
                 .sentence = "there is not enough memory to connect",
                 .mend = "",
                 .place = {.name = made.name_}};
  if (const auto ready = made.prepare_session(); !ready) return ready.error();
  return made;
}

Result<> SharedDatabase::prepare_session() const {
  PQsetNoticeProcessor(connection_.get(), [](void*, const char*) {}, nullptr);
  if (PQstatus(connection_.get()) != CONNECTION_OK) return trouble(nullptr);
  const char* encoding = PQparameterStatus(connection_.get(), "server_encoding");
  if (!encoding || std::string_view(encoding) != "UTF8")
    return Error{.code = Code::unreadable_file,
                 .sentence = fmt::format("the database keeps texts in {}, and an index has all languages",
                                         encoding ? encoding : "no encoding that it tells"),
                 .mend = "make a database for it: createdb --encoding UTF8 --template template0 NAME",
                 .place = {.name = name_}};
  return run("SELECT pg_catalog.set_config('search_path', '', false)");
}

Result<> SharedDatabase::reconnect() const {
  PQreset(connection_.get());
  return prepare_session();
}

std::string SharedDatabase::without_secrets(std::string text) const {
  for (const std::string& secret : secrets_)
    for (std::size_t at = 0; (at = text.find(secret, at)) != std::string::npos; at += 3)
      text.replace(at, secret.size(), "***");
  return text;
}

Error SharedDatabase::trouble(const PGresult* result) const {
  const char* state = result ? PQresultErrorField(result, PG_DIAG_SQLSTATE) : nullptr;
  last_state_ = state ? state : "";
  const char* said = state ? PQresultErrorField(result, PG_DIAG_MESSAGE_PRIMARY) : PQerrorMessage(connection_.get());
  const std::string why = without_secrets(first_line(said ? said : ""));
  if (PQstatus(connection_.get()) != CONNECTION_OK)
    return {.code = Code::unreadable_file,
            .sentence = fmt::format("the shared index cannot be reached: {}", why),
            .mend = "look whether the server runs and lets you in; a password is best kept in ~/.pgpass",
            .place = {.name = name_}};
  if (begins_with_any(last_state_, {"42P01", "42703", "3F000"}))  // a table, column or schema that is not there
    return {.code = Code::damaged_file,
            .sentence = fmt::format("this database has no index of Wale, or a damaged one: {}", why),
            .mend = "make one: `wale library index --index postgresql://…`",
            .place = {.name = name_}};
  const bool writes = begins_with_any(last_state_, {"25006", "53", "54", "23", "40"});
  return {.code = writes ? Code::unwritable_file : Code::unreadable_file,
          .sentence = fmt::format("the shared index refuses: {}", why),
          .mend = mend_of_state(last_state_),
          .place = {.name = name_}};
}

Result<Rows> SharedDatabase::ask(const char* sql, const std::vector<std::string>& values) const {
  std::vector<std::string> held;
  std::vector<const char*> texts;
  held.reserve(values.size());
  for (const std::string& each : values) texts.push_back(held.emplace_back(storable(each)).c_str());
  PGresult* result = PQexecParams(connection_.get(), sql, static_cast<int>(texts.size()), nullptr, texts.data(), nullptr,
                                  nullptr, 0);
  Rows rows(result);
  const ExecStatusType status = PQresultStatus(result);
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK) return trouble(result);
  return rows;
}

Result<> SharedDatabase::run(const char* sql, const std::vector<std::string>& values) const {
  const auto rows = ask(sql, values);
  return rows ? Result<>() : Result<>(rows.error());
}

Result<> SharedDatabase::run_all(const std::string& sql) const {
  PGresult* result = PQexec(connection_.get(), sql.c_str());
  const Rows rows(result);
  const ExecStatusType status = PQresultStatus(result);
  if (status != PGRES_TUPLES_OK && status != PGRES_COMMAND_OK) return trouble(result);
  return {};
}

Result<> SharedDatabase::in_transaction(const std::function<Result<>()>& work) const {
  std::minstd_rand random(std::random_device{}());
  for (int attempt = 1;; ++attempt) {
    last_state_.clear();
    auto done = run("BEGIN");
    if (done) done = work();
    if (done) done = run("COMMIT");
    if (done) return done;
    const std::string state = last_state_;
    const bool is_lost = PQstatus(connection_.get()) != CONNECTION_OK;
    if (!is_lost) static_cast<void>(run("ROLLBACK"));
    if (attempt == most_attempts || !(is_lost || may_go_well_again(state))) return done;
    // Longer each time, and not all at once.
    const auto longest = std::min(1 << attempt, 512);
    std::this_thread::sleep_for(std::chrono::milliseconds(1 + static_cast<int>(random() % static_cast<unsigned>(longest))));
    if (is_lost)
      if (const auto again = reconnect(); !again && attempt + 1 == most_attempts) return again;
  }
}

std::string array_of_texts(const std::vector<std::string>& texts) {
  std::string array = "{";
  for (const std::string& text : texts) {
    array += array.size() == 1 ? "\"" : ",\"";
    for (const char c : text) {
      if (c == '"' || c == '\\') array += '\\';
      array += c;
    }
    array += '"';
  }
  return array + "}";
}

std::string array_of_numbers(const std::vector<std::int64_t>& numbers) {
  return fmt::format("{{{}}}", fmt::join(numbers, ","));
}

}  // namespace wale
