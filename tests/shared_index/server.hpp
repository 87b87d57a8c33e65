#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "library/store/library_store.hpp"
#include "library/store/postgresql.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::shared_index {

inline std::string of_environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// The server that `with_postgresql` has started, and a new database for each test.
class Server : public testing::Test {
 protected:
  void SetUp() override {
    if (of_environment("PGHOST").empty())
      GTEST_SKIP() << "NOT TESTED: no server; tests/shared_index/with_postgresql starts one";
    static int number = 0;
    database_ = "trial_" + std::to_string(getpid()) + "_" + std::to_string(++number);
    admin_ = open("postgres");
    do_as_admin("CREATE DATABASE " + database_ + " ENCODING 'UTF8' LC_COLLATE 'C.UTF-8' LC_CTYPE 'C.UTF-8' TEMPLATE template0");
  }
  void TearDown() override {
    if (admin_) do_as_admin("DROP DATABASE IF EXISTS " + database_ + " WITH (FORCE)");
  }

  /// For the user who made the server, or for another with the password "trial".
  static std::string address(const std::string& database, const std::string& user = {}) {
    const std::string who = user.empty() ? of_environment("PGUSER") + ":" + of_environment("PGPASSWORD") : user + ":trial";
    return "postgresql://" + who + "@" + of_environment("PGHOST") + ":" + of_environment("PGPORT") + "/" + database;
  }
  std::string address() const { return address(database_); }
  std::string address_of(const std::string& user) const { return address(database_, user); }

  static std::unique_ptr<SharedDatabase> open(const std::string& database) {
    auto opened = SharedDatabase::open(address(database));
    EXPECT_TRUE(opened) << (opened ? "" : in_words(opened.error()));
    return opened ? std::make_unique<SharedDatabase>(*std::move(opened)) : nullptr;
  }
  void do_as_admin(const std::string& sql) const {
    const auto done = admin_->run_all(sql);
    EXPECT_TRUE(done) << sql << ": " << (done ? "" : in_words(done.error()));
  }
  /// The first number of what a statement gives in the trial database.
  std::int64_t number(const char* sql) const {
    const auto rows = open(database_)->ask(sql);
    EXPECT_TRUE(rows) << sql << ": " << (rows ? "" : in_words(rows.error()));
    return rows && rows->size() > 0 ? rows->number(0, 0) : -1;
  }

  std::string shelf(const std::string& name) const { return folder_ / name; }
  /// Writes a file of a library with the licence CC0-1.0.
  std::string write(const std::string& path, const std::string& text) const { return folder_.write(path, text); }
  void write_library(const std::string& name, const std::string& licence = "CC0-1.0") const {
    write(name + "/wale.project", "licence \"" + licence + "\"\n");
  }
  std::vector<LibraryFile> files_of(const std::string& name) const {
    return *library_files_in(std::vector<std::string>{folder_ / name});
  }

  TemporaryFolder folder_;
  std::string database_;
  std::unique_ptr<SharedDatabase> admin_;
};

/// Opens an index, or fails the test.
inline std::unique_ptr<LibraryStore> opened(const std::string& where, bool makes, const std::string& cache = {}) {
  auto store = LibraryStore::open(where, makes, cache);
  EXPECT_TRUE(store) << (store ? "" : in_words(store.error()));
  return store ? *std::move(store) : nullptr;
}

/// Brings it up to date, or fails the test.
inline StoreReport updated(LibraryStore& store, const std::vector<LibraryFile>& files, const Shelf& shelf = {}) {
  const auto report = store.bring_up_to_date(files, {}, {}, shelf);
  EXPECT_TRUE(report) << (report ? "" : in_words(report.error()));
  return report ? *report : StoreReport{};
}

/// A material with one rib pattern; `words` are its documentation.
inline std::string ribs(const std::string& name, double level, double period, const std::string& words,
                        const std::string& more = {}) {
  return "/// " + words + "\nmaterial " + name + " {\n  representative {\n    title \"The " + name + "\"\n    called \"ribbed " +
         name + "\"\n    called de \"Gröber " + name + "\"\n    kind trial.woven\n" + more +
         "  }\n  perceptual { roughness " + std::to_string(level) + " estimated }\n  physical {\n    height ribs = cos(2 pi * x / " +
         std::to_string(period) + " mm)\n    force = lateral(ribs)\n  }\n}\n";
}

}  // namespace wale::shared_index
