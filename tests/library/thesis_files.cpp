// The files of the thesis's Sandpaper, byte by byte as its manual (Minsky 1995, Appendix B, 3) describes them.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/temporary_folder.hpp"
#include "wale/language_service.hpp"
#include "wale/library.hpp"
#include "wale/thesis_files.hpp"

namespace wale::thesis_files_test {
namespace {

std::span<const std::byte> bytes_of(const std::string& text) { return std::as_bytes(std::span(text)); }

std::string golden(const std::string& name) {
  std::ifstream file(std::string(WALE_SOURCE_DIR) + "/tests/library/thesis_files/" + name, std::ios::binary);
  EXPECT_TRUE(file) << name;
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string text_of(const std::vector<std::byte>& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

TEST(ThesisFiles, AnArrayIsTwoCountsAndItsRows) {
  const std::string file = golden("ramp.depth");
  ASSERT_EQ(file.size(), 6u * 5 + 4);
  const auto array = read_thesis_array(bytes_of(file), "ramp.depth");
  ASSERT_TRUE(array) << in_words(array.error());
  EXPECT_EQ(array->width, 6);
  EXPECT_EQ(array->height, 5);
  for (int row = 0; row < 5; ++row)
    for (int column = 0; column < 6; ++column) EXPECT_EQ(array->cells[row * 6 + column], 40 * column + 10 * row);
  EXPECT_EQ(text_of(*write_thesis_array(*array)), file);
  // 258 by 3: the high byte comes first.
  const ThesisArray wide{258, 3, std::vector<std::uint8_t>(774, 7)};
  EXPECT_EQ(text_of(*write_thesis_array(wide)).substr(0, 4), std::string("\x01\x02\x00\x03", 4));
}

TEST(ThesisFiles, AnArrayOfAnotherSizeIsRefused) {
  const std::string file = golden("ramp.depth");
  const auto refused = [](const std::string& bytes) {
    const auto read = read_thesis_array(bytes_of(bytes), "bad.depth");
    EXPECT_FALSE(read);
    return read ? Error{} : read.error();
  };
  for (std::size_t size = 0; size < file.size(); ++size) {
    const Error error = refused(file.substr(0, size));
    EXPECT_EQ(error.code, Code::damaged_file);
    EXPECT_EQ(error.place.name, "bad.depth");
    EXPECT_EQ(error.place.number, size);
    EXPECT_FALSE(error.mend.empty());
  }
  const Error longer = refused(file + "x");
  EXPECT_EQ(longer.place.number, file.size());
  EXPECT_EQ(longer.expected, "34 bytes");
  EXPECT_EQ(longer.found, "35 bytes");
  EXPECT_EQ(refused(std::string("\0\0\0\5", 4)).place.number, 0u);
  EXPECT_EQ(refused(std::string("\0\5\0\0", 4)).place.number, 2u);
  EXPECT_EQ(refused(std::string("\xff\xff\xff\xff", 4)).expected, "4294836229 bytes");
  EXPECT_FALSE(write_thesis_array({2, 2, {1, 2, 3}}));
  EXPECT_FALSE(write_thesis_array({}));
}

TEST(ThesisFiles, AMovieIsAListOfNames) {
  const ThesisMovie expected{{"warm up", "grids", "warm up"}};
  for (const char* text : {"warm up\rgrids\rwarm up", "warm up\ngrids\nwarm up\n", "\r\nwarm up\r\n\r\ngrids\r\nwarm up\r\n"}) {
    const auto movie = read_thesis_movie(text, "demo");
    ASSERT_TRUE(movie) << in_words(movie.error());
    EXPECT_EQ(*movie, expected);
  }
  EXPECT_EQ(*read_thesis_movie(golden("demo.movie"), "demo.movie"), expected);
  EXPECT_EQ(*write_thesis_movie(expected), golden("demo.movie"));
}

TEST(ThesisFiles, MalformedMoviesAreRefusedWithTheirLine) {
  EXPECT_EQ(read_thesis_movie("", "m").error().code, Code::damaged_file);
  EXPECT_EQ(read_thesis_movie(" \r\r\n", "m").error().code, Code::damaged_file);
  const auto control = read_thesis_movie(std::string_view("a\nb\0c", 5), "m");
  EXPECT_EQ(control.error().place.number, 2u);
  const auto roman = read_thesis_movie("a\rb\rcaf\x8e", "m");
  EXPECT_EQ(roman.error().code, Code::invalid_encoding);
  EXPECT_EQ(roman.error().place.number, 3u);
  EXPECT_EQ(read_thesis_movie(std::string((4 << 20) + 1, 'a'), "m").error().code, Code::too_long);
  EXPECT_TRUE(write_thesis_movie({std::vector<std::string>(100, "a")}));
  EXPECT_FALSE(write_thesis_movie({std::vector<std::string>(101, "a")}));  // "Implementation Limits"
  for (const char* name : {"", " ", "a\nb", " a", "a ", "\xff"}) EXPECT_FALSE(write_thesis_movie({{name}})) << name;
}

TEST(ThesisFiles, AShuffleHasAHeaderAndPlaces) {
  const ThesisShuffle expected{"demo", "6/1/93", "14:03", 1, {{2, "plain cloth"}, {0, "grids"}, {1, "oil"}}};
  const auto read = read_thesis_shuffle(golden("demo.shuffle"), "demo.shuffle");
  ASSERT_TRUE(read) << in_words(read.error());
  EXPECT_EQ(*read, expected);
  EXPECT_EQ(*write_thesis_shuffle(expected), golden("demo.shuffle"));
  // On one line, as a reader of the manual may take it, with places from 0, and with a Macintosh's ends of lines.
  const auto other = read_thesis_shuffle("Movie:demo Date: 6/1/93 Time: 14:03\r\r2 plain cloth\r0\tgrids\r1 oil\r", "s");
  ASSERT_TRUE(other) << in_words(other.error());
  ThesisShuffle from_zero = expected;
  from_zero.first_number = 0;
  EXPECT_EQ(*other, from_zero);
  EXPECT_EQ(*read_thesis_shuffle(*write_thesis_shuffle(from_zero), "s"), from_zero);
}

TEST(ThesisFiles, MalformedShufflesAreRefusedWithTheirLine) {
  const std::string header = "Movie: m\nDate: d\nTime: t\n\n";
  const std::pair<std::string, std::size_t> cases[] = {
      {"", 1},
      {"Film: m\n", 1},
      {"Movie:\nDate: d\nTime: t\n\n1 a\n", 1},
      {"Movie: m\nTime: t\n", 2},
      {"Movie: m\nDate: d\n\n1 a\n", 3},
      {"Movie: m\nDate: d\nTime: t", 4},
      {"Movie: m\nDate: d\nTime: t\n1 a\n", 4},
      {header, 5},
      {header + "1 a\nb\n", 6},
      {header + "1 a\n2\n", 6},
      {header + "1a\n", 5},
      {header + "-1 a\n", 5},
      {header + "1 a\n3 b\n", 6},
      {header + "1 a\n1 b\n", 6},
      {header + "0 a\n2 b\n", 6},
      {header + "99999999999999999999999 a\n", 5},
      {header + "18446744073709551615 a\n", 5}};
  for (const auto& [text, line] : cases) {
    const auto read = read_thesis_shuffle(text, "s");
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, Code::damaged_file) << text;
    EXPECT_EQ(read.error().place.number, line) << text << in_words(read.error());
    EXPECT_FALSE(read.error().mend.empty()) << text;
  }
  EXPECT_FALSE(write_thesis_shuffle({"m", "d", "t", 1, {}}));
  EXPECT_FALSE(write_thesis_shuffle({"m", "d", "t", 2, {{0, "a"}}}));
  EXPECT_FALSE(write_thesis_shuffle({"m", "d", "t", 1, {{0, "a"}, {0, "b"}}}));
  EXPECT_FALSE(write_thesis_shuffle({"m", "", "t", 1, {{0, "a"}}}));
  EXPECT_TRUE(write_thesis_shuffle({"m Date: x Time: y", "d", "t", 1, {{0, "a"}}}).has_value() ==
              read_thesis_shuffle("Movie:m Date: x Time: y\nDate: d\nTime: t\n\n1 a\n", "s").has_value());
}

TEST(ThesisFiles, KindsAreSeen) {
  EXPECT_EQ(kind_of_thesis_file("a.depth", "x"), ThesisFileKind::surface);
  EXPECT_EQ(kind_of_thesis_file("a.shade", "x"), ThesisFileKind::shading);
  EXPECT_EQ(kind_of_thesis_file("a.wave", golden("ramp.depth")), ThesisFileKind::wave);
  EXPECT_EQ(kind_of_thesis_file("A.WAVE", golden("ramp.depth")), ThesisFileKind::wave);
  EXPECT_EQ(kind_of_thesis_file("a", golden("ramp.depth")), ThesisFileKind::array);
  EXPECT_EQ(kind_of_thesis_file("a", golden("demo.shuffle")), ThesisFileKind::shuffle);
  EXPECT_EQ(kind_of_thesis_file("a", golden("demo.movie")), ThesisFileKind::movie);
  EXPECT_EQ(kind_of_thesis_file("a", std::string("\x01\x20\x03\x00\x01", 5)), ThesisFileKind::workspace);
  EXPECT_FALSE(unread_thesis_workspace("a").mend.empty());
}

TEST(ThesisFiles, NamesBecomeNamesOfTheLanguage) {
  EXPECT_EQ(wale_name("pictures/barsB15W20_2.depth", {}), "barsB15W20_2");
  EXPECT_EQ(wale_name("grid 3.shade", {"grid_3"}), "grid_3_2");
  EXPECT_EQ(wale_name("3 grids", {}), "n3_grids");
  EXPECT_EQ(wale_name("if", {}), "if_");
  EXPECT_EQ(wale_name("café — ½", {}), "caf");
  EXPECT_EQ(wale_name("", {}), "unnamed");
  EXPECT_EQ(wale_name("***", {"unnamed"}), "unnamed_2");
}

/// A material of the thesis in a folder of its own, compiled.
class Compiling : public ::testing::Test {
 protected:
  Result<Compiled> compile(const ThesisInWale& made) {
    for (const FileBeside& each : made.files) std::ofstream(folder / each.name, std::ios::binary) << each.bytes;
    return library.compile("wale 1\n\n" + made.text, {.name = folder / "made.wale"});
  }
  TemporaryFolder folder;
  Library library;
};

/// A grating of 16 by 8 cells, with a step in one row.
ThesisArray some_array() {
  ThesisArray array{16, 8, {}};
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 16; ++column)
      array.cells.push_back(static_cast<std::uint8_t>((column * 37 + row * 91) % 256));
  array.cells[3] = 0, array.cells[9] = 255;
  return array;
}

TEST_F(Compiling, AnArrayIsFeltAndComesBackAsTheSameBytes) {
  const ThesisArray array = some_array();
  const auto made = surface_in_wale(array, {.name = "rock", .file = "rock.depth", .amplitude = 0.75});
  ASSERT_TRUE(made) << in_words(made.error());
  EXPECT_EQ(made->files.size(), 1u);
  const auto compiled = compile(*made);
  ASSERT_TRUE(compiled) << in_words(compiled.error()) << made->text;
  // 16 by 8 pixels of 0.37 mm.
  EXPECT_NEAR(compiled->program.default_size().width, 16 * 0.37e-3, 1e-8);
  EXPECT_NEAR(compiled->program.default_size().height, 8 * 0.37e-3, 1e-8);
  Bank bank(compiled->program);
  const auto back = surface_of(bank, {.width = 16, .height = 8, .heights = std::pair(0.0, 1e-3)});
  ASSERT_TRUE(back) << in_words(back.error());
  EXPECT_EQ(*back, array);
  EXPECT_EQ(*surface_of(bank, {.width = 16, .height = 8}), array);  // it has 0 and 255
  // A hand on a flank is pushed downhill.
  ThesisArray ramp{16, 8, {}};
  for (int i = 0; i < 128; ++i) ramp.cells.push_back(static_cast<std::uint8_t>(i % 16 * 16));
  const auto slope = compile(*surface_in_wale(ramp, {.name = "rock", .file = "rock.depth", .amplitude = 0.75}));
  ASSERT_TRUE(slope);
  Bank on_slope(slope->program);
  const Force force = tick(on_slope, {});
  EXPECT_NEAR(force.x, -0.75, 0.1);  // the height grows to the right
  EXPECT_NEAR(force.y, 0, 1e-3);
}

TEST_F(Compiling, AShadingIsItsPicture) {
  ThesisArray shading = some_array();
  const auto made = surface_in_wale(some_array(), {.name = "rock", .file = "rock.depth", .amplitude = 0.75}, &shading);
  ASSERT_TRUE(made);
  const auto compiled = compile(*made);
  ASSERT_TRUE(compiled) << in_words(compiled.error()) << made->text;
  const auto back = shading_of(Bank(compiled->program), {.width = 16, .height = 8});
  ASSERT_TRUE(back) << in_words(back.error());
  EXPECT_EQ(*back, shading);
  shading.width = 8, shading.height = 16;
  EXPECT_EQ(surface_in_wale(some_array(), {.name = "a", .file = "a", .amplitude = 1}, &shading).error().code, Code::image_size);
}

TEST_F(Compiling, AWaveRepeatsAndItsPeriodIsASlider) {
  ThesisArray wave{64, 4, {}};
  for (int i = 0; i < 256; ++i) wave.cells.push_back(static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * std::sin(2 * M_PI * (i % 64) / 64))));
  const auto made = wave_in_wale(wave, {.name = "seed", .file = "seed", .amplitude = 1.0, .period = 2.5e-3});
  ASSERT_TRUE(made) << in_words(made.error());
  const auto compiled = compile(*made);
  ASSERT_TRUE(compiled) << in_words(compiled.error()) << made->text;
  const Bank bank(compiled->program);
  // Three periods to either side it is the same wave, also across its ends.
  for (int shift = -3; shift <= 3; ++shift) {
    std::vector<glm::vec2> places;
    std::vector<float> heights(64), first(64);
    for (int i = 0; i < 64; ++i) places.push_back({(i - 31.5) / 64 * 2.5e-3 + shift * 2.5e-3, 1e-3 * shift});
    relief_all(bank, places, heights);
    for (int i = 0; i < 64; ++i) EXPECT_NEAR(heights[i], wave.cells[i] / 255.0 * 1e-3, 4e-6) << shift << " " << i;
  }
  // The sampled period comes back.
  EXPECT_EQ(surface_of(bank, {.width = 64, .height = 4, .cell = 2.5e-3 / 64})->cells.size(), 256u);
  const auto& parameters = compiled->program.description().parameters;
  ASSERT_FALSE(parameters.empty());
  EXPECT_EQ(parameters.front().name, "period");
  // A force of a sine: its amplitude is that of the lateral force.
  Bank felt(compiled->program);
  float most = 0;
  for (int i = 0; i < 500; ++i) most = std::max(most, std::abs(tick(felt, {.position = {i * 1e-5f, 0}}).x));
  EXPECT_NEAR(most, 1.0, 0.1);
}

TEST_F(Compiling, AWaveWhoseRowsDifferRepeatsBothWays) {
  const ThesisArray wave = some_array();
  const auto made = wave_in_wale(wave, {.name = "seed", .file = "seed", .amplitude = 1.0, .period = 16e-3});
  const auto compiled = compile(*made);
  ASSERT_TRUE(compiled) << in_words(compiled.error()) << made->text;
  const Bank bank(compiled->program);
  std::vector<glm::vec2> places;
  for (int row = 0; row < 8; ++row)
    for (int column = 0; column < 16; ++column) places.push_back({(column - 7.5 + 16) * 1e-3, (3.5 - row - 8) * 1e-3});
  std::vector<float> heights(places.size());
  relief_all(bank, places, heights);
  for (std::size_t i = 0; i < heights.size(); ++i) EXPECT_NEAR(heights[i], wave.cells[i] / 255.0 * 1e-3, 4e-6) << i;
}

TEST_F(Compiling, FlatOnesAndTinyOnesAndFiguresThatMakeNoSense) {
  const ThesisSurfaceOptions options{.name = "flat", .file = "flat", .amplitude = 1, .period = 1e-3};
  for (const auto& made : {surface_in_wale({4, 4, std::vector<std::uint8_t>(16, 9)}, options),
                           wave_in_wale({1, 1, {9}}, options), wave_in_wale({3, 2, {0, 9, 0, 0, 9, 0}}, options)}) {
    ASSERT_TRUE(made);
    const auto compiled = compile(*made);
    EXPECT_TRUE(compiled) << in_words(compiled.error()) << made->text;
  }
  EXPECT_EQ(surface_in_wale({3, 40, std::vector<std::uint8_t>(120, 9)}, options).error().code, Code::image_size);
  EXPECT_EQ(wave_in_wale({4001, 1, std::vector<std::uint8_t>(4001, 9)}, options).error().code, Code::image_size);
  ThesisSurfaceOptions wrong = options;
  for (const double figure : {0.0, -1.0, HUGE_VAL, std::nan("")}) {
    wrong = options, wrong.amplitude = figure;
    EXPECT_EQ(surface_in_wale(some_array(), wrong).error().code, Code::malformed_value);
    wrong = options, wrong.cell = figure;
    EXPECT_EQ(surface_in_wale(some_array(), wrong).error().code, Code::malformed_value);
    wrong = options, wrong.period = figure;
    EXPECT_EQ(wave_in_wale(some_array(), wrong).error().code, Code::malformed_value);
  }
}

TEST_F(Compiling, SamplingSaysWhatItCannot) {
  const auto compiled = library.find("corduroy");
  ASSERT_TRUE(compiled);
  const Bank bank(compiled->program);
  EXPECT_TRUE(surface_of(bank, {.width = 8, .height = 8}));
  EXPECT_EQ(surface_of(bank, {}).error().code, Code::malformed_value);
  EXPECT_EQ(surface_of(bank, {.width = 65535, .height = 65535}).error().code, Code::image_size);
  EXPECT_EQ(surface_of(bank, {.width = 64, .height = 8, .heights = std::pair(0.0, 1e-9)}).error().code, Code::value_out_of_range);
  EXPECT_EQ(surface_of(bank, {.width = 64, .height = 8, .heights = std::pair(1.0, 0.0)}).error().code, Code::value_out_of_range);
  EXPECT_EQ(surface_of(bank, {.width = 1, .height = 1}).error().code, Code::flat_height);
  EXPECT_EQ(shading_of(bank, {.width = 8, .height = 8}).error().code, Code::flat_height);
}

TEST(ThesisFiles, AMovieIsADeclaration) {
  const LanguageService language;
  const std::string before = "wale 1\n\nworkspace grids { patch a = oak }\n\n";
  const auto made = movie_in_wale({{"warm up", "grids", "3", "warm up"}}, {.name = "demo", .file = "demo.movie", .workspaces = {"grids"}, .taken = {"warm_up"}});
  ASSERT_TRUE(made) << in_words(made.error());
  EXPECT_NE(made->text.find("frames warm_up_2, grids, n3, warm_up_2"), std::string::npos) << made->text;
  const Library library;
  const auto shown = library.presentation(before + made->text);
  ASSERT_TRUE(shown) << in_words(shown.error()) << made->text;
  EXPECT_EQ(shown->movies.front().frames, (std::vector<std::string>{"warm_up_2", "grids", "n3", "warm_up_2"}));
  EXPECT_EQ(*language.format(before + made->text), *language.format(*language.format(before + made->text)));
  const auto shuffled = shuffle_in_wale(*read_thesis_shuffle(golden("demo.shuffle"), "s"), {.name = "order", .file = "s"});
  const auto order = library.presentation("wale 1\n\n" + shuffled->text);
  ASSERT_TRUE(order) << in_words(order.error()) << shuffled->text;
  EXPECT_EQ(order->movies.front().frames, (std::vector<std::string>{"plain_cloth", "grids", "oil"}));
  EXPECT_FALSE(movie_in_wale({}, {.name = "demo"}));
}

}  // namespace
}  // namespace wale::thesis_files_test
