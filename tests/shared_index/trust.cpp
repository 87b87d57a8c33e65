// Who may do what with a shared index, what it says when something is wrong, and what it does not let in.
#include <chrono>
#include <thread>

#include "library/index/find.hpp"
#include "library/store/shared_changes.hpp"
#include "library/store/shared_roles.hpp"
#include "tests/shared_index/server.hpp"

namespace wale::shared_index::trust_test {
namespace {

class Trust : public Server {
 protected:
  void make_one() {
    write_library("shelf");
    write("shelf/one.wale", "wale 1\n" + ribs("one", 0.5, 2, "One."));
    updated(*opened(address(), true), files_of("shelf"));
  }
  /// A user with the password "trial", who is a member of a role, if it is named.
  std::string make_user(const std::string& what, const std::string& role) {
    const std::string user = what + "_" + database_;
    do_as_admin("CREATE ROLE " + user + " LOGIN PASSWORD 'trial'" + (role.empty() ? "" : " IN ROLE " + role));
    users_.push_back(user);
    return user;
  }
  void TearDown() override {
    if (admin_) do_as_admin("DROP DATABASE IF EXISTS " + database_ + " WITH (FORCE)");
    for (const std::string& user : users_) do_as_admin("DROP ROLE " + user);
    Server::TearDown();
  }
  static Error refusal(const Result<std::unique_ptr<LibraryStore>>& opened) {
    EXPECT_FALSE(opened);
    return opened ? Error{} : opened.error();
  }
  static void expect_told(const Error& error, Code code, const std::string& part) {
    EXPECT_EQ(error.code, code) << in_words(error);
    EXPECT_NE(in_words(error).find(part), std::string::npos) << in_words(error);
    EXPECT_FALSE(error.mend.empty()) << in_words(error);
    EXPECT_EQ(explained(error).find("trial@"), std::string::npos) << explained(error);
  }

  std::vector<std::string> users_;
};

TEST_F(Trust, EachRoleMayNoMoreThanItNeeds) {
  make_one();
  ASSERT_TRUE(open(database_)->run_all(roles_of_shared_index()));
  ASSERT_TRUE(open(database_)->run_all(roles_of_shared_index())) << "also again";
  const std::string reader = make_user("reader", "wale_reader"), curator = make_user("curator", "wale_curator"),
                    owner = make_user("owner", "wale_owner"), nobody = make_user("nobody", "");
  expect_told(refusal(LibraryStore::open(address_of(nobody), false)), Code::unreadable_file, "permission denied");

  write("shelf/two.wale", "wale 1\n" + ribs("two", 0.6, 3, "Two."));
  EXPECT_TRUE(meant_entry(opened(address_of(reader), false)->index(), "one"));
  const auto refused = opened(address_of(reader), true)->bring_up_to_date(files_of("shelf"), {});
  ASSERT_FALSE(refused);
  expect_told(refused.error(), Code::unreadable_file, "permission denied");
  EXPECT_EQ(updated(*opened(address_of(curator), true), files_of("shelf")).materials, 2u);
  std::filesystem::remove(folder_ / "shelf/two.wale");
  EXPECT_EQ(updated(*opened(address_of(curator), true), files_of("shelf"), {.name = {}, .is_whole = true, .forgets = true}).gone, 1u);

  const auto may = [&](const std::string& user, const std::string& sql) {
    const auto database = SharedDatabase::open(address_of(user));
    return database && database->run_all("BEGIN; " + sql + "; ROLLBACK");
  };
  for (const char* sql : {"DELETE FROM wale.materials", "INSERT INTO wale.gone VALUES(1, 1)", "UPDATE wale.present SET state = 0"}) {
    EXPECT_FALSE(may(reader, sql)) << sql;
    EXPECT_TRUE(may(curator, sql)) << sql;
  }
  for (const char* sql : {"DROP TABLE wale.words", "TRUNCATE wale.materials CASCADE", "UPDATE wale.facts SET value = '9'", "CREATE TABLE wale.mine(x text)",
                          "ALTER TABLE wale.files ADD COLUMN x text", "DELETE FROM wale.present", "DROP SCHEMA wale CASCADE"}) {
    EXPECT_FALSE(may(reader, sql)) << sql;
    EXPECT_FALSE(may(curator, sql)) << sql;
    EXPECT_TRUE(may(owner, sql)) << sql;
  }
}

/// Version 1 is the first step of the tables; what later ones made is taken away here.
constexpr const char* to_version_1 =
    "DROP TABLE wale.gone, wale.states; ALTER TABLE wale.materials DROP COLUMN state; "
    "ALTER TABLE wale.present DROP COLUMN state, DROP COLUMN stamp; UPDATE wale.facts SET value = '1' WHERE name = 'version'";

TEST_F(Trust, BringsOlderTablesToThisVersionAndRefusesNewerOnes) {
  make_one();
  ASSERT_TRUE(open(database_)->run_all(roles_of_shared_index()));
  const std::string curator = make_user("curator", "wale_curator"), owner = make_user("owner", "wale_owner");
  ASSERT_TRUE(open(database_)->run_all(to_version_1));
  expect_told(refusal(LibraryStore::open(address_of(curator), false)), Code::damaged_file, "has version 1, and this Wale reads 2; its owner");
  expect_told(refusal(LibraryStore::open(address_of(curator), true)), Code::damaged_file, "has version 1, and this Wale reads 2; its owner");
  EXPECT_EQ(number("SELECT value::integer FROM wale.facts WHERE name = 'version'"), 1);
  {
    const auto store = opened(address_of(owner), true);
    EXPECT_TRUE(meant_entry(store->index(), "one"));
  }
  EXPECT_EQ(number("SELECT value::integer FROM wale.facts WHERE name = 'version'"), 2);
  // The curator may use the tables that are new.
  write("shelf/one.wale", "wale 1\n" + ribs("another", 0.5, 2, "One."));
  EXPECT_EQ(updated(*opened(address_of(curator), true), files_of("shelf")).materials, 1u);
  EXPECT_EQ(number("SELECT count(*) FROM wale.gone"), 1);

  ASSERT_TRUE(open(database_)->run_all("UPDATE wale.facts SET value = '3' WHERE name = 'version'"));
  for (const bool makes : {false, true})
    expect_told(refusal(LibraryStore::open(address(), makes)), Code::newer_file, "has version 3, and this Wale reads 2");
}

/// Many who make the tables at once make them once.
TEST_F(Trust, IsMadeOnce) {
  std::vector<std::thread> makers;
  std::vector<std::string> said(6);
  for (std::string& each : said)
    makers.emplace_back([&] {
      const auto store = LibraryStore::open(address(), true);
      if (!store) each = in_words(store.error());
    });
  for (std::thread& each : makers) each.join();
  for (const std::string& each : said) EXPECT_EQ(each, "");
}

TEST_F(Trust, SaysWhatIsWrongAndNeverThePassword) {
  const std::string host = of_environment("PGHOST") + ":" + of_environment("PGPORT");
  expect_told(refusal(LibraryStore::open(address(), false)), Code::damaged_file, "has no index of Wale");
  expect_told(refusal(LibraryStore::open(address("no_such_database"), false)), Code::unreadable_file, "no_such_database");
  const std::string secret = "s3cret";
  for (const std::string& wrong :
       {"postgresql://anna:" + secret + "@" + host + "/postgres", "postgresql://anna:" + secret + "@127.0.0.1:1/postgres",
        "postgresql://anna:" + secret + "@nowhere.invalid/x", "postgresql://anna:" + secret + "%zz@" + host + "/x",
        "postgresql://anna@" + host + "/x?password=" + secret, "postgresql://anna@" + host + "/x?password=" + secret + "&nonsense=1",
        "postgresql://anna:a@b/" + secret + "@" + host + "/x", "postgresql://anna:" + secret + "@[::1/x",
        "postgresql://anna:s%33cret@" + host + "/x", "postgresql://anna@" + host + "/x?sslpassword=" + secret + "&password=" + secret}) {
    const Error error = refusal(LibraryStore::open(wrong, true));
    EXPECT_TRUE(error.code == Code::unreadable_file || error.code == Code::malformed_value) << in_words(error);
    EXPECT_FALSE(error.mend.empty());
    for (const std::string& text : {explained(error), error.place.name, error.sentence})
      EXPECT_EQ(text.find(secret), std::string::npos) << text;
  }
  do_as_admin("CREATE DATABASE " + database_ + "_latin ENCODING 'LATIN1' LC_COLLATE 'C' LC_CTYPE 'C' TEMPLATE template0");
  expect_told(refusal(LibraryStore::open(address(database_ + "_latin"), true)), Code::unreadable_file, "LATIN1");
  do_as_admin("DROP DATABASE " + database_ + "_latin");
}

/// The database asks to do it again, as it does where serialisation fails: a trigger does so twice. Its sequence counts also
/// what is taken back.
TEST_F(Trust, DoesAgainWhatOthersWereInTheWayOf) {
  make_one();
  ASSERT_TRUE(open(database_)->run_all(
      "CREATE SEQUENCE public.tries; CREATE FUNCTION public.refuse() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN "
      "IF pg_catalog.nextval('public.tries') <= 2 THEN RAISE EXCEPTION 'in the way' USING ERRCODE = '40001'; END IF; RETURN NEW; END $$; "
      "CREATE TRIGGER refuses BEFORE INSERT ON wale.states FOR EACH ROW EXECUTE FUNCTION public.refuse()"));
  write("shelf/one.wale", "wale 1\n" + ribs("one", 0.7, 2, "Once more."));
  updated(*opened(address(), true), files_of("shelf"));
  EXPECT_EQ(number("SELECT last_value FROM public.tries"), 3);
  const auto store = opened(address(), false);
  EXPECT_EQ(store->index().entry(*meant_entry(store->index(), "one"))->documentation, "Once more.");
}

/// Where the server ends a connection, the work is done again on another one.
TEST_F(Trust, SurvivesALostConnection) {
  make_one();
  const auto store = opened(address(), true);
  do_as_admin("SELECT pg_catalog.pg_terminate_backend(pid) FROM pg_catalog.pg_stat_activity WHERE datname = '" + database_ + "'");
  const auto lost = meant_entry(store->index(), "one");
  ASSERT_FALSE(lost);
  expect_told(lost.error(), Code::unreadable_file, "cannot be reached");
  const auto database = open(database_);
  int tries = 0;
  EXPECT_TRUE(database->in_transaction([&]() -> Result<> {
    if (++tries == 1)
      do_as_admin("SELECT pg_catalog.pg_terminate_backend(pid) FROM pg_catalog.pg_stat_activity WHERE datname = '" + database_ + "'");
    return database->run("UPDATE wale.present SET device = device");
  }));
  EXPECT_EQ(tries, 2);
}

TEST_F(Trust, PassesOnOnlyWhatEverybodyMayPassOn) {
  write_library("shelf");
  write_library("unfit", "CC-BY-NC-4.0");
  write("shelf/free.wale", "wale 1\n" + ribs("free", 0.5, 2, "Free.") +
                               ribs("bound", 0.5, 3, "The secret text.", "    licence \"CC-BY-ND-4.0\"\n"));
  write("unfit/ours.wale", "wale 1\n" + ribs("ours", 0.5, 2, "The secret text."));
  const auto store = opened(address(), true);
  for (int round = 0; round < 2; ++round) {
    const StoreReport report = updated(*store, files_of("shelf"));
    EXPECT_EQ(report.materials, 1u);
    ASSERT_EQ(report.kept_back.size(), 1u) << "also when nothing has changed";
    EXPECT_EQ(report.kept_back[0].material, "bound");
    EXPECT_EQ(report.kept_back[0].why, "its licence, CC-BY-ND-4.0, does not let everybody pass it on");
  }
  EXPECT_EQ(updated(*store, files_of("unfit")).kept_back.size(), 1u);
  EXPECT_EQ(number("SELECT count(*) FROM wale.materials WHERE entry LIKE '%secret%'"), 0);
  // The licence of the library changes, and nothing else.
  write_library("unfit", "CC-BY-4.0");
  EXPECT_EQ(updated(*store, files_of("unfit")).materials, 2u);
  write_library("unfit", "CC-BY-NC-4.0");
  EXPECT_EQ(updated(*store, files_of("unfit")).materials, 1u);
  // What a material rests on counts too.
  write("unfit/part.wale", "wale 1\nexport let rib = 2 mm\n");
  write("unfit/uses.wale", "wale 1\nimport part\n" + ribs("uses", 0.5, 2, "Uses.", "    licence \"CC0-1.0\"\n"));
  const StoreReport uses = updated(*store, files_of("unfit"));
  ASSERT_EQ(uses.kept_back.size(), 2u);
  EXPECT_EQ(uses.kept_back[1].material, "uses");
  EXPECT_NE(uses.kept_back[1].why.find("it rests on a file whose licence"), std::string::npos) << uses.kept_back[1].why;
}

TEST_F(Trust, IsOfOneDeviceAndOfLibrariesOnly) {
  make_one();
  FileRequest other;
  other.device = "sidewinder_ffb2";
  const auto refused = opened(address(), true)->bring_up_to_date(files_of("shelf"), other);
  ASSERT_FALSE(refused);
  expect_told(refused.error(), Code::other_device, "is for the device `sandpaper`");
  write("loose/alone.wale", "wale 1\n" + ribs("alone", 0.5, 2, "Alone."));
  const auto loose = opened(address(), true)->bring_up_to_date(files_of("loose"), {});
  ASSERT_FALSE(loose);
  expect_told(loose.error(), Code::unfit_file, "wale.project");
}

/// Two laboratories may call their library the same, and then say under which name it stands in the index they share.
TEST_F(Trust, KeepsWhatOthersGaveUnlessToldToForget) {
  make_one();
  write("far/shelf/wale.project", "licence \"CC0-1.0\"\n");
  write("far/shelf/one.wale", "wale 1\n" + ribs("one", 0.9, 4, "Another."));
  const auto store = opened(address(), true);
  EXPECT_EQ(updated(*store, files_of("far/shelf"), {.name = "far", .is_whole = true}).materials, 2u);
  std::filesystem::remove(folder_ / "shelf/one.wale");
  write("shelf/two.wale", "wale 1\n" + ribs("two", 0.5, 2, "Two."));
  const StoreReport told = updated(*store, files_of("shelf"), {.name = {}, .is_whole = true});
  EXPECT_EQ(told.materials, 3u);
  EXPECT_EQ(told.only_there, 1u);
  const StoreReport part = updated(*store, files_of("shelf"));
  EXPECT_EQ(part.only_there, 0u) << "of a part of a library nobody knows what is gone";
  const StoreReport forgotten = updated(*store, files_of("shelf"), {.name = {}, .is_whole = true, .forgets = true});
  EXPECT_EQ(forgotten.gone, 1u);
  EXPECT_EQ(forgotten.materials, 2u);
  EXPECT_EQ(store->index().entry(*meant_entry(store->index(), "one"))->file, "far/one.wale");
  EXPECT_EQ(number(("SELECT count(*) FROM wale.files WHERE rests_on LIKE '%" + folder_.path().filename().string() + "%'").c_str()), 0)
      << "no path of a curator's computer";
}

}  // namespace
}  // namespace wale::shared_index::trust_test
