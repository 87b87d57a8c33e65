// Texts that somebody else wrote, in everything that a command prints: names in patch programs, titles and comments of
// Wale files, paths, values of options, recordings. Nothing that a terminal obeys gets out, no text pretends to be a
// line of ours, generated C++ is the same code, and every --json is JSON.

#include <gtest/gtest.h>

#include <cctype>
#include <cstdlib>
#include <span>
#include <string>
#include <vector>

#include "tests/command_line/running.hpp"
#include "wale/patch_program.hpp"

namespace wale::command_line::hostile_test {
namespace {

using Words = std::vector<std::string>;

/// Ends a comment or a text, begins a line, moves the cursor, sets a title, turns the writing around, is not UTF-8.
const std::string hostile = "x\x1b[2J\x1b]0;t\a\u009b31m\u202e\u2028\x7f\xff\r*/\nforged: line\n#error forged\n\"\\";
/// The same without line breaks, as a text in a Wale file may be.
const std::string hostile_line = "x\x1b[2J\x1b]0;t\a\u009b31m\u202e\u2028\x7f*/";

std::string shown(const std::string& text) {
  std::string all;
  for (const unsigned char c : text)
    all += c >= ' ' && c < 0x7F ? std::string(1, char(c)) : "<" + std::to_string(c) + ">";
  return all;
}

/// The first place at which a text is not plain UTF-8 that a terminal shows, by the tables of Unicode; empty if there
/// is none.
std::string obeyed_part(const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    const unsigned first = byte(at);
    const std::size_t length = first < 0x80 ? 1 : first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : first >= 0xC2 ? 2 : 0;
    unsigned code = length == 1 ? first : first & (0x7Fu >> length);
    bool whole = length > 0 && first <= 0xF4;
    for (std::size_t i = 1; i < length; ++i) {
      whole = whole && (byte(at + i) & 0xC0) == 0x80;
      code = code << 6 | (byte(at + i) & 0x3F);
    }
    const bool obeyed = (code < 0x20 && code != '\n' && code != '\t') || (code >= 0x7F && code <= 0x9F) ||
                        code == 0x61C || code == 0x200E || code == 0x200F || (code >= 0x2028 && code <= 0x202E) ||
                        (code >= 0x2066 && code <= 0x2069);
    if (!whole || obeyed) return shown(text.substr(at > 40 ? at - 40 : 0, 80));
    at += length;
  }
  return {};
}

bool has_forged_line(const std::string& text) {
  return text.starts_with("forged") || contains(text, "\nforged") || contains(text, "\n#error forged");
}

void expect_harmless(const Outcome& outcome, const Words& words) {
  const std::string command = shown(testing::PrintToString(words));
  EXPECT_EQ(obeyed_part(outcome.out), "") << command;
  EXPECT_EQ(obeyed_part(outcome.err), "") << command;
  EXPECT_FALSE(has_forged_line(outcome.out)) << command << outcome.out;
  EXPECT_FALSE(has_forged_line(outcome.err)) << command << outcome.err;
  EXPECT_LT(outcome.status, 3) << command << outcome.err;
  const bool is_json = std::find(words.begin(), words.end(), "--json") != words.end() && !outcome.out.empty();
  EXPECT_TRUE(!is_json || nlohmann::json::accept(outcome.out)) << command << outcome.out;
}

/// Runs a command, and expects of its outputs what must be true of any.
Outcome harmless(const Words& words) {
  Outcome outcome = wale(words);
  expect_harmless(outcome, words);
  return outcome;
}

PatchProgram corduroy_program(const TemporaryFolder& folder) {
  EXPECT_EQ(wale({"build", corduroy, "-o", folder / "honest.wpp"}).status, 0);
  const std::string bytes = bytes_of(folder / "honest.wpp");
  return *read_patch_program(std::as_bytes(std::span(bytes)));
}

std::string written(const TemporaryFolder& folder, const std::string& name, const PatchProgram& program) {
  const auto bytes = write_patch_program(program);
  return folder.write(name, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// The program with `text` behind each of its texts.
PatchProgram with_texts(PatchProgram program, const std::string& text, bool device_too) {
  program.material += text;
  if (device_too) program.device.name += text;
  for (auto& each : program.parameters)
    each.name += text, each.unit += text, each.si_unit += text, each.description += text;
  for (auto& each : program.states) each.name += text, each.si_unit += text;
  for (auto& each : program.grids) each.name += text, each.si_unit += text;
  for (auto& each : program.percepts)
    for (std::string* field : {&each.name, &each.carrier, &each.map, &each.device, &each.source, &each.unit,
                               &each.weber_source, &each.realisation})
      *field += text;
  for (auto& each : program.fates) each.name += text, each.reason += text;
  for (auto& [key, values] : program.layers.representative) {
    if (key != "title") key += text;
    for (std::string& value : values) value += text;
  }
  program.layers.perceptual += text, program.layers.physical += text, program.layers.documentation += "x";
  for (std::string& file : program.places.files) file += text;
  return program;
}

/// All verbs that read a program or a Wale file.
std::vector<Words> reading(const std::string& file, const TemporaryFolder& folder) {
  const std::string run = folder / "run.wrec";
  return {{"check", file},
          {"check", file, "--json"},
          {"format", "--check", file},
          {"build", file, "-o", folder / "out.wpp"},
          {"build", file, "--all", "-o", folder / "all"},
          {"build", file, "--emit", "tree"},
          {"build", file, "--emit", "checked"},
          {"build", file, "--emit", "ir"},
          {"build", file, "--emit", "listing"},
          {"build", file, "--emit", "cpp"},
          {"describe", file},
          {"describe", file, "--json"},
          {"describe", file, "--exports"},
          {"describe", file, "--exports", "--json"},
          {"describe", file, "--device", "all"},
          {"describe", file, "--device", "all", "--json"},
          {"describe", file, "--set", "nothing=1"},
          {"describe", file, "--material", "nothing"},
          {"compare", file, "velvet"},
          {"compare", file, "velvet", "denim"},
          {"compare", file, "velvet", "--json"},
          {"feel", file, "--virtual-time", "--seconds", "0.1", "--record", run},
          {"feel", file, "--virtual-time", "--seconds", "0.1", "--json"},
          {"feel", file, "--virtual-time", "--seconds", "0.1", "--record", folder / "table.csv"},
          {"feel", file, "--against", "velvet", "--blind", "--device", "simulated", "--seconds", "0.1"},
          {"replay", run},
          {"replay", run, "--json"},
          {"replay", file},
          {"sample", file, "--at", "0 mm, 0 mm", "--json"},
          {"sample", file, "--at", "0 mm, 0 mm", "--set", "nothing=1"},
          {"preview", file, "-o", folder / "out.png"}};
}

TEST(HostileText, InProgramsIsShownByEveryVerb) {
  const TemporaryFolder folder;
  const PatchProgram honest = corduroy_program(folder);
  for (const bool device_too : {false, true}) {
    const std::string file = written(folder, "hostile.wpp", with_texts(honest, hostile, device_too));
    for (const Words& words : reading(file, folder)) harmless(words);
    if (device_too) continue;
    const Outcome described = harmless({"describe", file});
    EXPECT_EQ(described.status, 0) << described.err;
    EXPECT_TRUE(contains(described.out, "corduroyx\\u001b[2J")) << described.out;
    EXPECT_TRUE(contains(described.out, "\\u202e")) << described.out;
    const Outcome run = wale({"feel", file, "--virtual-time", "--seconds", "0.1"});
    EXPECT_EQ(run.status, 0) << run.err;
  }
}

// What a text is must not change what the code is: comments are the only place for it, and names keep letters only.
std::vector<std::string> tokens_of(const std::string& code, const TemporaryFolder& folder) {
  const std::string file = folder.write("code.cpp", code);
  const std::string command = std::string(WALE_CXX_COMPILER) + " -w -std=c++20 -fpreprocessed -dD -E -P -trigraphs " +
                              quoted(file) + " -o " + quoted(folder / "tokens");
  EXPECT_EQ(std::system(command.c_str()), 0);
  const std::string text = bytes_of(folder / "tokens");
  std::vector<std::string> tokens;
  for (std::size_t at = 0; at < text.size();) {
    const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.'; };
    std::size_t end = at + 1;
    if (is_word(text[at]))
      while (end < text.size() && is_word(text[end])) ++end;
    std::string token = text.substr(at, end - at);
    // Names that hold the text differ; a word that is not of the honest code is called one.
    if (contains(token, "forged")) token = "NAME";
    // The namespace ends with a hash of the header, comments included.
    constexpr std::size_t arithmetic = 24;
    if (token.starts_with("WALE_ARITHMETIC_") && token.size() > arithmetic) token.resize(arithmetic);
    if (!std::isspace(static_cast<unsigned char>(token[0]))) tokens.push_back(token);
    at = end;
  }
  return tokens;
}

TEST(HostileText, IsNoCodeInGeneratedCpp) {
  const TemporaryFolder folder;
  const PatchProgram honest = corduroy_program(folder);
  const auto emitted = [&](const std::string& text) {
    const Words words{"build", written(folder, "emitted.wpp", with_texts(honest, text, false)), "--emit", "cpp"};
    const Outcome outcome = harmless(words);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out;
  };
  const auto expected = tokens_of(emitted("_forged"), folder);
  ASSERT_GT(expected.size(), 500u);
  for (const char* text : {"\n#error forged", "\nint forged;//", "*/ int forged; /*forged", " forged\\", " forged\?\?/",
                           "\"forged", "\u2028int forged;", "\rint forged;\n", " forged\\ \t", "\\u000aint forged;"})
    EXPECT_EQ(tokens_of(emitted(text), folder), expected) << shown(text);
}

std::string hostile_wale() {
  const std::string text = hostile_line + "\\nforged: line";  // as a text spells a line break
  return "wale 1\n\n/// Documented " + hostile_line + "\nexport let wide = 2 mm\n\n/// Documented " + hostile_line +
         "\nmaterial hostile {\n  representative {\n    title \"" + text + "\"\n    called \"" + text + "\", \"" +
         text + "2\"\n    feels \"" + text + "\"\n  }\n  perceptual { roughness 0.5 }\n}\n";
}

TEST(HostileText, InWaleFilesIsShownByEveryVerb) {
  const TemporaryFolder folder;
  const std::string file = folder.write("library/hostile.wale", hostile_wale());
  for (const Words& words : reading(file, folder)) harmless(words);
  EXPECT_EQ(wale({"describe", file}).status, 0) << wale({"describe", file}).err;
  for (const char* sought : {"hostile", "documented"}) {
    const Outcome found = harmless({"find", sought, "--library", folder / "library"});
    EXPECT_EQ(found.status, 0) << found.err;
    EXPECT_TRUE(contains(found.out, "\\u001b")) << found.out;
    EXPECT_EQ(harmless({"find", sought, "--library", folder / "library", "--json"}).status, 0);
  }
  harmless({"describe", hostile_line, "--library", folder / "library"});
}

TEST(HostileText, InMessagesAboutAFileIsShown) {
  const TemporaryFolder folder;
  const std::vector<std::string> texts{
      "wale 1\nmaterial m { representative { title \"" + hostile_line + "\" } perceptual { roughnes 0.5 } }\n",
      "wale 1\nmaterial m { perceptual { " + hostile_line + " } }\n",
      "wale 1\nimport " + hostile_line + "\n",
      "wale 1\nmaterial m { physical { height h = image(\"" + hostile_line +
          "\", scale: 1 mm/px, height: 1 mm)\n"
          "  force = lateral(h, amplitude: 1 N) } }\n",
      "wale 1\nmaterial m { physical { length t = table(\"" + hostile_line + "\", 1 mm) } }\n",
      hostile_line,
      hostile,
      "wale 1\n// \xff\n"};
  for (const std::string& text : texts) {
    const std::string file = folder.write("wrong.wale", text);
    EXPECT_EQ(harmless({"check", file, "--json"}).status, 1) << shown(text);
    for (const Words& words : {Words{"check", file},
                               {"describe", file},
                               {"compare", file, "velvet"},
                               {"format", file},
                               {"check", "--fix", file}})
      harmless(words);  // the last two mend some of these
  }
  for (const std::string& text : {hostile, "t,x,y\n" + hostile_line + ",0,0\n", hostile_line + ",x,y\n0,0,0\n"})
    EXPECT_EQ(harmless({"sample", corduroy, "--trace", folder.write("wrong.csv", text)}).status, 1) << shown(text);
}

TEST(HostileText, InPathsIsShownByEveryVerb) {
  const TemporaryFolder folder;
  const std::string file = folder / "a\n\x1b[2J\u202e\xff\nforged.wale";
  fs::copy_file(corduroy, file);
  for (const Words& words : reading(file, folder)) harmless(words);
  EXPECT_EQ(wale({"describe", file}).status, 0);
  const Outcome checked = harmless({"check", file, "--json"});
  EXPECT_EQ(checked.status, 0) << checked.err;
  const std::string wrong = folder.write("a\n\x1b[2J\u202e\xff\nforged/wrong.wale",
                                         "wale 1\nimport nothing\nmaterial m { perceptual { roughnes 0.5 } }\n");
  for (const Words& words : reading(wrong, folder)) EXPECT_NE(harmless(words).status, 3);
  const std::string run = folder / "a\n\x1b[2J\u202e\xff\nforged.wrec", table = folder / "\x1b\nforged.csv";
  const Words feel{"feel", file, "--virtual-time", "--seconds", "0.1"};
  const auto with = [](Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  EXPECT_EQ(harmless(with(feel, {"--record", run})).status, 0);
  EXPECT_EQ(harmless(with(feel, {"--record", table})).status, 0);
  EXPECT_EQ(harmless(with(feel, {"--hand", table, "--json"})).status, 0);
  EXPECT_EQ(harmless(with(feel, {"--hand", table, "--record", folder / "b.wrec"})).status, 0);
  for (const std::string& each : {run, folder / "b.wrec"}) {
    EXPECT_EQ(harmless({"replay", each}).status, 0);
    EXPECT_EQ(harmless({"replay", each, "--json"}).status, 0);
  }
  const std::string missing = folder / "\x1b[2J\nforged/missing";
  for (const Words& words : reading(missing + ".wale", folder)) harmless(words);
  for (const char* suffix : {".wpp", ".png", ".csv"})
    EXPECT_EQ(harmless({suffix == std::string(".wpp")   ? "build"
                        : suffix == std::string(".png") ? "preview"
                                                        : "sample",
                        corduroy, "-o", missing + suffix})
                  .status,
              suffix == std::string(".csv") ? 2 : 1);
  EXPECT_EQ(harmless({"devices", "--devices", missing}).status, 1);
  harmless({"describe", folder / "."});
}

TEST(HostileText, InWordsOfTheCommandIsShown) {
  for (const Words& words : std::vector<Words>{{hostile},
                                               {"--" + hostile},
                                               {"describe", corduroy, "--" + hostile},
                                               {"describe", corduroy, hostile},
                                               {"describe", hostile},
                                               {"describe", corduroy, "--device", hostile},
                                               {"describe", corduroy, "--material", hostile},
                                               {"describe", corduroy, "--set", hostile},
                                               {"describe", corduroy, "--set", "wale=" + hostile},
                                               {"describe", corduroy, "--set", hostile + "=1"},
                                               {"describe", corduroy, "--library", hostile},
                                               {"describe", corduroy + ":" + hostile},
                                               {"build", corduroy, "--emit", hostile},
                                               {"feel", corduroy, "--device", hostile},
                                               {"feel", corduroy, "--hand", hostile},
                                               {"feel", corduroy, "--record", hostile},
                                               {"feel", corduroy, "--seconds", hostile},
                                               {"feel", corduroy, "--built-for", hostile},
                                               {"feel", corduroy, "--max-force", hostile},
                                               {"feel", corduroy, "--transport", hostile},
                                               {"feel", corduroy, "--against", hostile, "--blind"},
                                               {"sample", corduroy, "--at", hostile},
                                               {"levels", hostile},
                                               {"levels", "roughness", "--device", hostile},
                                               {"levels", "roughness", "--steps", hostile},
                                               {"find", "--kind", hostile},
                                               {"explain", hostile},
                                               {"compare", hostile, corduroy},
                                               {"replay", hostile},
                                               {"replay", hostile, "--wav", hostile},
                                               {"devices", "--identify", hostile},
                                               {"devices", "--devices", hostile}})
    EXPECT_NE(harmless(words).status, 0) << shown(testing::PrintToString(words));
  // One of its words may be that of a material.
  harmless({"find", hostile});
  harmless({"find", hostile, "--json"});
}

TEST(HostileText, InDeclarationsOfDevicesIsShown) {
  const TemporaryFolder folder;
  std::string text = bytes_of(std::string(WALE_SOURCE_DIR) + "/calibration/devices/falcon.wale");
  const auto source = text.find("a record of");
  ASSERT_NE(source, std::string::npos);
  text.insert(source, hostile_line);
  const auto name = text.find("device falcon");
  ASSERT_NE(name, std::string::npos);
  text.replace(name, 13, "export device strange");
  const std::string file = folder.write("devices.wale", text);
  const Outcome listed = harmless({"devices", "--devices", file});
  EXPECT_EQ(listed.status, 0) << listed.err;
  EXPECT_TRUE(contains(listed.out, "\\u001b[2J")) << listed.out;
  EXPECT_EQ(harmless({"devices", "--devices", file, "--json"}).status, 0);
}

}  // namespace
}  // namespace wale::command_line::hostile_test
