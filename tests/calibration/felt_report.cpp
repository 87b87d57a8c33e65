// The report of a run: the count of each guard, and the cost of each step of a tick.
#include "calibration/feel/felt_report.hpp"

#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace wale::felt_report_test {
namespace {

TEST(FeltReport, CountsEachGuardByItsName) {
  FeltReport report;
  const std::map<std::string, long GuardCounts::*> guards{{"slew", &GuardCounts::slew},
                                                          {"device_limit", &GuardCounts::device_limit},
                                                          {"user_limit", &GuardCounts::user_limit},
                                                          {"heat", &GuardCounts::heat},
                                                          {"energy", &GuardCounts::energy},
                                                          {"passivity", &GuardCounts::passivity},
                                                          {"not_a_number", &GuardCounts::not_a_number},
                                                          {"overrun", &GuardCounts::overrun},
                                                          {"stale", &GuardCounts::stale},
                                                          {"lost", &GuardCounts::lost},
                                                          {"restored", &GuardCounts::restored}};
  ASSERT_EQ(guards.size() * sizeof(long), sizeof(GuardCounts)) << "a guard is missing here";
  long count = 1001;
  for (const auto& [name, guard] : guards) report.guards.*guard = count++;
  const auto json = nlohmann::json::parse(felt_json(report));
  const std::string text = felt_text(report);
  for (const auto& [name, guard] : guards) {
    EXPECT_EQ(json.at("guards").at(name), report.guards.*guard) << name;
    EXPECT_NE(text.find(std::to_string(report.guards.*guard)), std::string::npos) << name << " in\n" << text;
  }
  EXPECT_EQ(json.at("guards").size(), guards.size());
}

TEST(FeltReport, HasTheCostOfATickAndItsLargestStep) {
  FeltReport report;
  EXPECT_FALSE(nlohmann::json::parse(felt_json(report)).contains("cost")) << "there are no costs in virtual time";
  EXPECT_EQ(felt_text(report).find("  cost"), std::string::npos);
  TickCosts costs{.whole = {50e-6, 90e-6, 120e-6}, .of = {}};
  costs.of[TickCosts::sample] = {30e-6, 60e-6, 70e-6};
  costs.of[TickCosts::command] = {12e-6, 80e-6, 99e-6};
  report.costs = costs;
  const auto cost = nlohmann::json::parse(felt_json(report)).at("cost");
  EXPECT_EQ(cost.at("tick").at("p99_s"), 90e-6);
  EXPECT_EQ(cost.at("command").at("max_s"), 99e-6);
  for (const char* step : {"sample", "find", "program", "guard", "command", "record"})
    EXPECT_TRUE(cost.at(step).contains("p50_s")) << step;
  EXPECT_EQ(cost.size(), 1 + TickCosts::steps);
  const std::string text = felt_text(report);
  EXPECT_NE(text.find("cost         p50 50.0 us, p99 90.0 us a tick; most of it to sample: p50 30.0 us, p99 60.0 us\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace wale::felt_report_test
