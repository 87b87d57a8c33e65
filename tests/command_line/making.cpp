// The outputs of the verbs for a material: programs, descriptions, samples, records, pictures.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/command_line/running.hpp"

namespace wale::command_line::making_test {
namespace {

/// The fields of the last line of a CSV text.
std::vector<double> last_line(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line, last;
  while (std::getline(lines, line))
    if (!line.empty()) last = line;
  std::vector<double> fields;
  std::istringstream parts(last);
  for (std::string field; std::getline(parts, field, ',');) fields.push_back(std::stod(field));
  return fields;
}

TEST(Build, SameFileSameBytes) {
  const TemporaryFolder folder;
  const std::string one = folder / "one.wpp", two = folder / "two.wpp";
  EXPECT_EQ(wale({"build", corduroy, "-o", one}).status, 0);
  EXPECT_EQ(wale({"build", corduroy, "-o", two, "--material", "corduroy", "--device", "sandpaper"}).status, 0);
  EXPECT_GT(bytes_of(one).size(), 500u);
  EXPECT_EQ(bytes_of(one), bytes_of(two));
}

TEST(Build, NothingIsWrittenWhenTheMaterialIsWrong) {
  const TemporaryFolder folder;
  const std::string wrong = folder.write("wrong.wale", "wale 1\nmaterial a { physical { force = 3 N } }\n");
  EXPECT_EQ(wale({"build", wrong, "-o", folder / "out.wpp"}).status, 1);
  EXPECT_FALSE(fs::exists(folder / "out.wpp"));
}

TEST(PatchPrograms, AFlippedByteIsRefusedWithAReason) {
  const TemporaryFolder folder;
  const std::string whole = folder / "whole.wpp";
  ASSERT_EQ(wale({"build", corduroy, "-o", whole}).status, 0);
  const std::string bytes = bytes_of(whole);
  for (const std::size_t at : {std::size_t{0}, std::size_t{9}, bytes.size() / 3, bytes.size() / 2, bytes.size() - 1}) {
    std::string flipped = bytes;
    flipped[at] = static_cast<char>(flipped[at] ^ 0x10);
    const std::string file = folder.write("flipped.wpp", flipped);
    for (const auto& words :
         std::vector<std::vector<std::string>>{{"describe", file},
                                               {"sample", file, "--at", "1 mm, 0 mm"},
                                               {"feel", file, "--virtual-time", "--seconds", "0.1"}}) {
      const Outcome outcome = wale(words);
      EXPECT_EQ(outcome.status, 1) << "byte " << at;
      const bool is_version = at == 9;  // the format is read before the checksum, which a newer one may place elsewhere
      EXPECT_TRUE(contains(outcome.err, is_version ? "error[W0507]" : "error[W0506]")) << "byte " << at << outcome.err;
    }
  }
  for (const std::size_t size : {std::size_t{0}, std::size_t{7}, bytes.size() / 2, bytes.size() - 1}) {
    const Outcome outcome = wale({"describe", folder.write("cut.wpp", bytes.substr(0, size))});
    EXPECT_EQ(outcome.status, 1) << size << " bytes";
    EXPECT_TRUE(contains(outcome.err, "error[W0506]") || contains(outcome.err, "error[W0606]")) << outcome.err;
  }
}

TEST(PatchPrograms, DescribeAndSampleAsTheirSourceDoes) {
  const TemporaryFolder folder;
  const std::string program = folder / "corduroy.wpp";
  ASSERT_EQ(wale({"build", corduroy, "-o", program}).status, 0);
  EXPECT_EQ(wale({"describe", program, "--json"}).json(), wale({"describe", corduroy, "--json"}).json());
  EXPECT_EQ(wale({"sample", program, "--at", "10.6 mm, 5 mm"}).out,
            wale({"sample", corduroy, "--at", "10.6 mm, 5 mm"}).out);
}

TEST(Describe, JsonHasPerceptsForceAndParameters) {
  const Outcome outcome = wale({"describe", corduroy, "--json"});
  EXPECT_EQ(outcome.status, 0);
  const auto description = outcome.json();
  EXPECT_EQ(description.at("material"), "corduroy");
  EXPECT_EQ(description.at("device"), "sandpaper");
  const auto& roughness = description.at("percepts").at("roughness");
  EXPECT_NEAR(roughness.at("level").get<double>(), 0.6, 1e-6);
  // 10^(0.759593 log10(99.02 pu) - 0.513365)
  EXPECT_NEAR(roughness.at("magnitude").get<double>(), std::pow(10, 0.759593 * std::log10(1.93406 * 51.2) - 0.513365),
              1e-3);
  EXPECT_NEAR(description.at("force").at("max_newton").get<double>(), 1.934, 0.001);
  EXPECT_GT(description.at("instructions").get<int>(), 10);
  const auto& wale = description.at("parameters").at(0);
  EXPECT_EQ(wale.at("name"), "wale");
  EXPECT_EQ(wale.at("unit"), "mm");
  EXPECT_DOUBLE_EQ(wale.at("value").get<double>(), 2.5);
  EXPECT_DOUBLE_EQ(wale.at("min").get<double>(), 1);
  EXPECT_DOUBLE_EQ(wale.at("max").get<double>(), 5);
}

TEST(Describe, SeveralMaterialsAreAnArray) {
  const TemporaryFolder folder;
  const std::string two = folder.write(
      "two.wale",
      "wale 1\nmaterial a { perceptual { roughness 0.5 } }\nmaterial b { physical { force = viscous(2 N s/m) } }\n");
  const auto described = wale({"describe", two, "--json"}).json();
  ASSERT_TRUE(described.is_array());
  ASSERT_EQ(described.size(), 2u);
  EXPECT_EQ(described[0].at("material"), "a");
  EXPECT_EQ(described[1].at("material"), "b");
  EXPECT_TRUE(wale({"describe", two, "--json", "--material", "b"}).json().is_object());
}

TEST(Describe, TextHasAllThreeLayers) {
  const std::string text = wale({"describe", corduroy}).out;
  for (const char* part : {"Wide-wale corduroy", "roughness", "0.6", "1.93", "measured", "Minsky 1995", "wale", "mm"})
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
}

TEST(Set, ChangesAParameter) {
  const auto described = wale({"describe", corduroy, "--json", "--set", "wale=5mm", "--set", "roughness=0.3"}).json();
  EXPECT_NEAR(described.at("parameters").at(0).at("value").get<double>(), 5, 1e-5);
  EXPECT_NEAR(described.at("percepts").at("roughness").at("level").get<double>(), 0.3, 1e-6);
  EXPECT_NEAR(described.at("force").at("max_newton").get<double>(), 0.777, 0.001);
}

TEST(Set, TakesAnyUnitOfTheDimension) {
  EXPECT_EQ(wale({"sample", corduroy, "--at", "0.6 mm, 0 mm", "--set", "wale=0.5 cm"}).out,
            wale({"sample", corduroy, "--at", "0.6 mm, 0 mm", "--set", "wale=5 mm"}).out);
}

TEST(Set, ErrorsSayWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> errors{{"wale=9mm", "from 1 mm to 5 mm"},
                                                                {"wale=2 N", "expected length, found force"},
                                                                {"wale=2", "write `2 mm`"},
                                                                {"wael=2mm", "no parameter `wael`"},
                                                                {"wale", "NAME=VALUE"},
                                                                {"wale=", "wale"},
                                                                {"wale=2 mm, 3 mm", "2 values"},
                                                                {"roughness=1.2", "from 0 to 1"},
                                                                {"wale=nan", "nan"}};
  for (const auto& [setting, reason] : errors) {
    const Outcome outcome = wale({"describe", corduroy, "--set", setting});
    EXPECT_EQ(outcome.status, 2) << setting;
    EXPECT_TRUE(contains(outcome.err, reason)) << setting << "\n" << outcome.err;
    EXPECT_EQ(outcome.out, "") << setting;
  }
}

TEST(Sample, AtAPlace) {
  // A quarter of a period right of a ridge's middle the slope is steepest, so the force is downhill with the full
  // amplitude.
  const Outcome outcome = wale({"sample", corduroy, "--at", "0.625 mm, 0 mm"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(outcome.out.starts_with("t (s),x (m),y (m),vx (m/s),vy (m/s),fx (N),fy (N)\n")) << outcome.out;
  const auto fields = last_line(outcome.out);
  ASSERT_EQ(fields.size(), 7u);
  EXPECT_NEAR(fields[1], 0.000625, 1e-9);
  EXPECT_NEAR(fields[5], 1.934, 0.002);
  EXPECT_NEAR(fields[6], 0, 1e-6);
  const auto json = wale({"sample", corduroy, "--at", "-0.625 mm, 0 mm, 0.1 m/s, 0 m/s", "--json"}).json();
  ASSERT_EQ(json.size(), 1u);
  EXPECT_NEAR(json[0].at("fx").get<double>(), -1.934, 0.002);
  EXPECT_NEAR(json[0].at("vx").get<double>(), 0.1, 1e-6);
}

TEST(Sample, TheForceOutsideThePatchIsZero) {
  EXPECT_EQ(last_line(wale({"sample", corduroy, "--at", "90.6 mm, 0 mm"}).out).at(5), 0);
}

TEST(Sample, InvalidPlacesAreErrors) {
  for (const char* at : {"", "10 mm", "10, 5", "10 mm, 5 N", "1 mm, 2 mm, 3 m/s", "ten mm, 5 mm", "x, y"}) {
    const Outcome outcome = wale({"sample", corduroy, "--at", at});
    EXPECT_EQ(outcome.status, 2) << at;
    EXPECT_FALSE(outcome.err.empty()) << at;
  }
}

TEST(Sample, ThroughATrace) {
  const TemporaryFolder folder;
  const std::string trace = folder.write("trace.csv", "t (s), x (mm), y (mm)\n0, 0, 0\n0.1, 0.625, 0\n0.2, 1.25, 0\n");
  const Outcome to_file = wale({"sample", corduroy, "--trace", trace, "-o", folder / "out.csv"});
  EXPECT_EQ(to_file.status, 0);
  EXPECT_EQ(to_file.out, "");
  const std::string csv = bytes_of(folder / "out.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 4);
  EXPECT_EQ(csv, wale({"sample", corduroy, "--trace", trace}).out);
  const auto json = wale({"sample", corduroy, "--trace", trace, "--json"}).json();
  ASSERT_EQ(json.size(), 3u);
  EXPECT_NEAR(json[0].at("fx").get<double>(), 0, 0.01);
  EXPECT_NEAR(json[1].at("fx").get<double>(), 1.934, 0.002);
  EXPECT_NEAR(json[2].at("fx").get<double>(), 0, 0.01);

  const Outcome wrong = wale({"sample", corduroy, "--trace", folder.write("wrong.csv", "t, x\n0, 1\n")});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_TRUE(contains(wrong.err, "wrong.csv:")) << wrong.err;
  EXPECT_EQ(wale({"sample", corduroy, "--trace", folder / "missing.csv"}).status, 1);
}

TEST(Feel, MeasuresTheAskedLevel) {
  const auto felt = wale({"feel", corduroy, "--virtual-time", "--json"}).json();
  EXPECT_EQ(felt.at("ticks").at("run"), 4500);
  EXPECT_EQ(felt.at("ticks").at("missed"), 0);
  EXPECT_NEAR(felt.at("actuator_rubbing").at("p99_newton").get<double>(), 1.934, 0.01934 + 10.0 / 2048);
  EXPECT_NEAR(felt.at("percepts").at("roughness").at("level").get<double>(), 0.6, 0.01);
  const std::string text = wale({"feel", corduroy, "--virtual-time"}).out;
  for (const char* part : {"1.93", "P99", "crossings", "roughness", "0.60"})
    EXPECT_TRUE(contains(text, part)) << part << "\n" << text;
}

TEST(Feel, AnotherRoughnessIsAnotherForce) {
  const TemporaryFolder folder;
  const std::string file = folder.write("fine.wale", corduroy_with("roughness 0.6", "roughness 0.3"));
  const auto felt = wale({"feel", file, "--virtual-time", "--json"}).json();
  EXPECT_NEAR(felt.at("actuator_rubbing").at("p99_newton").get<double>(), 0.777, 0.00777 + 10.0 / 2048);
  EXPECT_NEAR(felt.at("percepts").at("roughness").at("level").get<double>(), 0.3, 0.01);
}

TEST(Feel, AnotherPeriodIsTheSameRoughness) {
  const auto felt = wale({"feel", corduroy, "--virtual-time", "--json", "--set", "wale=5mm"}).json();
  EXPECT_NEAR(felt.at("actuator_rubbing").at("p99_newton").get<double>(), 1.934, 0.01934 + 10.0 / 2048);
}

TEST(Feel, AtRestThereIsNoMeasuredLevel) {
  const Outcome rest = wale({"feel", corduroy, "--virtual-time", "--hand", "rest", "--json"});
  EXPECT_EQ(rest.status, 0);
  EXPECT_EQ(rest.json().at("alternations"), 0);
  EXPECT_FALSE(rest.json().at("percepts").at("roughness").contains("level")) << rest.out;
}

TEST(Feel, VirtualTimeIsTheSameBytesTwice) {
  const TemporaryFolder folder;
  for (const std::string hand : {"lateral", "circular"}) {
    const std::string one = folder / (hand + "1.csv"), two = folder / (hand + "2.csv");
    EXPECT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "2", "--hand", hand, "--record", one}).status, 0);
    EXPECT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "2", "--hand", hand, "--record", two}).status, 0);
    const std::string record = bytes_of(one);
    EXPECT_EQ(std::count(record.begin(), record.end(), '\n'), 1801) << "a header, and one line per tick";
    for (const char* unit : {"(s)", "(m)", "(m/s)", "(N)"})
      EXPECT_TRUE(contains(record.substr(0, record.find('\n')), unit)) << unit;
    EXPECT_EQ(record, bytes_of(two));
  }
}

TEST(Feel, ARecordIsATraceToFollow) {
  const TemporaryFolder folder;
  ASSERT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "1", "--record", folder / "run.csv"}).status, 0);
  EXPECT_EQ(wale({"feel", corduroy, "--virtual-time", "--seconds", "1", "--hand", folder / "run.csv"}).status, 0);
  EXPECT_EQ(wale({"sample", corduroy, "--trace", folder / "run.csv"}).status, 0);
}

TEST(Feel, InvalidTimesAreRefused) {
  for (const char* seconds : {"0", "-1", "1e9", "nan"}) {
    const Outcome outcome = wale({"feel", corduroy, "--virtual-time", "--seconds", seconds});
    EXPECT_NE(outcome.status, 0) << seconds;
    EXPECT_FALSE(outcome.err.empty()) << seconds;
  }
}

TEST(Preview, WritesAPicture) {
  const TemporaryFolder folder;
  const std::string one = folder / "one.png", two = folder / "two.png";
  EXPECT_EQ(wale({"preview", corduroy, "-o", one}).status, 0);
  const std::string picture = bytes_of(one);
  EXPECT_TRUE(picture.starts_with("\x89PNG\r\n\x1a\n"));
  EXPECT_GT(picture.size(), 10000u);
  EXPECT_EQ(wale({"preview", corduroy, "-o", two}).status, 0);
  EXPECT_EQ(picture, bytes_of(two));
}

TEST(Preview, UnknownFormatsAreRefused) {
  const TemporaryFolder folder;
  const Outcome outcome = wale({"preview", corduroy, "-o", folder / "out.wall"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_FALSE(outcome.err.empty());
  EXPECT_FALSE(fs::exists(folder / "out.wall"));
}

}  // namespace
}  // namespace wale::command_line::making_test
