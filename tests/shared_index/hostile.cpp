// What somebody may contribute to do harm: it is kept as it is written, found by its words, and harms nothing else.
#include <map>

#include "library/index/entry_json.hpp"
#include "library/index/find.hpp"
#include "library/store/shared_changes.hpp"
#include "tests/shared_index/server.hpp"

namespace wale::shared_index::hostile_test {
namespace {

using Hostile = Server;

const std::vector<std::string>& hostile_texts() {
  static const std::vector<std::string> texts = {
      "'; DROP TABLE wale.materials CASCADE; --",
      "\"; DELETE FROM wale.words; --",
      "$1 $$ $tag$ \\x00 \\' E'\\''",
      "{\"a\",NULL,b}",
      std::string("before\0after", 12),
      "\xff\xfe\x80 not UTF-8 \xc3",
      "\xed\xa0\x80 half of a pair \xf4\x90\x80\x80",
      "<script>alert(1)</script><img src=x onerror=alert(1)>",
      std::string(100'000, 'x'),
      std::string(5'000, '\'') + std::string(5'000, '\\') + std::string(5'000, '"'),
      "\u202egnirts\u0000\u0007\u001b[2J\r\n",
      "null", "NULL", "", "%_%", "\xf4\x8f\xbf\xbf",
      [] {  // a very long title of many words
        std::string all;
        for (int i = 0; i < 20'000; ++i) all += "word" + std::to_string(i) + " ";
        return all;
      }()};
  return texts;
}

SharedChange innocent() {
  SharedChange made{{"shelf", "good.wale", ""}, {"good", "[]", ""}, {}};
  Entry& entry = made.entries.emplace_back();
  entry.name = "good", entry.module = "good", entry.title = "A good one", entry.licence = "CC0-1.0", entry.content = "1";
  return made;
}

/// Each text in each place at once, given past the language, which would refuse many of them.
TEST_F(Hostile, TextsInEveryPlaceAreTextsOnly) {
  opened(address(), true);
  const auto database = open(database_);
  ASSERT_TRUE(put_into_shared(*database, {innocent()}, default_device));
  std::size_t count = 1;
  for (const std::string& text : hostile_texts()) {
    SharedChange made{{text, text, ""}, {text, text, text}, {}};
    for (int i = 0; i < 2; ++i) {  // the same name twice in a file
      Entry& entry = made.entries.emplace_back();
      entry.name = entry.module = entry.kind = entry.title = entry.documentation = entry.file = entry.folder = text;
      entry.licence = entry.device = entry.content = text;
      if (i == 1) entry.trouble = text;
      entry.names = {{text, text}}, entry.feels = entry.asks = entry.replaces = entry.sources = {text};
      entry.felt.percepts.push_back({.name = text.substr(0, 80'000), .asked = 0.5, .reads = 0.5, .carrier = text, .size = 1});
    }
    const auto put = put_into_shared(*database, {made}, default_device);
    ASSERT_TRUE(put) << in_words(put.error()) << " of " << text.substr(0, 40);
    ASSERT_TRUE(put_into_shared(*database, {made}, default_device)) << "also again";
    count += 2;
    const auto store = opened(address(), false);
    const MaterialIndex& index = store->index();
    ASSERT_EQ(index.columns().size(), count);
    EXPECT_EQ(index.words().size().materials, count);
    EXPECT_TRUE(meant_entry(index, "a good one"));
    // The entry comes back as one in a file would: through JSON, with U+FFFD for what is no text.
    const auto json = nlohmann::ordered_json::parse(
        entry_json(made.entries.front()).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    const auto last = index.entry(index.columns().material(count - 2));
    ASSERT_TRUE(last) << in_words(last.error());
    EXPECT_EQ(entry_json(*last), entry_json(*entry_of_json(json)));
    for (const std::string& asked : {text.substr(0, 300), std::string("good")}) {
      EXPECT_TRUE(find_entries(index, {.texts = {asked}, .kind = {}, .without = {}, .most = 5}));
      EXPECT_TRUE(index.meant_by(asked));
    }
    EXPECT_EQ(index.meant_by(text)->size(), text.empty() ? 0u : 2u) << text.substr(0, 40);
  }
  const auto taken = take_out_of_shared(*database, {SharedFile{hostile_texts()[0], hostile_texts()[0], ""}.key()}, default_device);
  ASSERT_TRUE(taken);
  EXPECT_EQ(*taken, 2u);
  EXPECT_EQ(number("SELECT count(*) FROM pg_catalog.pg_tables WHERE schemaname = 'wale'"), 8);
  EXPECT_EQ(number("SELECT count(*) FROM wale.materials"), static_cast<std::int64_t>(count - 2));
}

/// The way a contribution comes: by files, whose names and texts are hostile. Both databases say the same of them.
TEST_F(Hostile, ContributionsDoTheSameInBothDatabases) {
  write_library("shelf");
  write("shelf/good.wale", "wale 1\n" + ribs("good", 0.5, 2, "Good."));
  int number_of_file = 0;
  for (const std::string& text : hostile_texts()) {
    const std::string name = "shelf/h" + std::to_string(++number_of_file) + ".wale";
    write(name, "wale 1\n/// " + text + "\nmaterial h" + std::to_string(number_of_file) +
                    " {\n  representative {\n    title \"" + text + "\"\n    called \"" + text + "\"\n  }\n  physical { force = lateral(cos(2 pi * x / 3 mm)) }\n}\n");
  }
  write("shelf/'; DROP TABLE wale.files; --.wale", "wale 1\n" + ribs("quoted", 0.5, 3, "Its file is called so."));
  write("shelf/\xff\xfe.wale", "wale 1\n" + ribs("bytes", 0.5, 4, "Its file's name is no text."));
  const auto shared = opened(address(), true), in_file = opened(folder_ / "an.index", true);
  const StoreReport one = updated(*shared, files_of("shelf")), other = updated(*in_file, files_of("shelf"));
  EXPECT_EQ(one.materials + one.kept_back.size(), other.materials);
  std::map<std::string, std::string> contents;
  for (const MaterialIndex* index : {&in_file->index(), &shared->index()})
    for (std::size_t row = 0; row < index->columns().size(); ++row) {
      const auto entry = index->entry(index->columns().material(row));
      ASSERT_TRUE(entry) << in_words(entry.error());
      const std::string told = entry->name + entry->title + entry->documentation + entry->trouble;
      if (index == &in_file->index()) contents[entry->module + "." + entry->name] = told;
      EXPECT_EQ(contents[entry->module + "." + entry->name], told);
    }
  for (const char* name : {"good", "quoted", "bytes"}) EXPECT_TRUE(meant_entry(shared->index(), name)) << name;
}

}  // namespace
}  // namespace wale::shared_index::hostile_test
