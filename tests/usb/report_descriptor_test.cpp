#include "runtime/device/hid_pid/report_descriptor.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/usb/pid_descriptor.hpp"

namespace wale::hid {
namespace {

using test::Items;

ReportDescriptor parsed(const std::vector<std::uint8_t>& bytes) {
  auto result = parse_report_descriptor(bytes);
  if (!result) {
    ADD_FAILURE() << result.error().sentence;
    return {};
  }
  return *std::move(result);
}

void expect_error(const std::vector<std::uint8_t>& bytes, std::size_t offset, const std::string& reason) {
  const auto result = parse_report_descriptor(bytes);
  ASSERT_FALSE(result) << reason;
  EXPECT_EQ(result.error().sentence,
            "its report descriptor is damaged at byte " + std::to_string(offset) + ": " + reason);
  EXPECT_EQ(result.error().place.number, offset) << reason;
}

TEST(ReportDescriptor, MouseOfTheStandard) {
  // HID 1.11, appendix E.10.
  const ReportDescriptor mouse =
      parsed({0x05, 0x01, 0x09, 0x02, 0xA1, 0x01, 0x09, 0x01, 0xA1, 0x00, 0x05, 0x09, 0x19, 0x01, 0x29, 0x03, 0x15,
              0x00, 0x25, 0x01, 0x95, 0x03, 0x75, 0x01, 0x81, 0x02, 0x95, 0x01, 0x75, 0x05, 0x81, 0x01, 0x05, 0x01,
              0x09, 0x30, 0x09, 0x31, 0x15, 0x81, 0x25, 0x7F, 0x75, 0x08, 0x95, 0x02, 0x81, 0x06, 0xC0, 0xC0});
  ASSERT_EQ(mouse.collections.size(), 2u);
  EXPECT_EQ(mouse.collections[0], (Collection{usage(1, 2), 1, -1}));
  EXPECT_EQ(mouse.collections[1], (Collection{usage(1, 1), 0, 0}));
  ASSERT_EQ(mouse.reports.size(), 1u);
  const Report& report = mouse.reports[0];
  EXPECT_EQ(report.id, 0);
  EXPECT_EQ(report.bytes(), 3u);
  ASSERT_EQ(report.fields.size(), 2u);
  const Field& buttons = report.fields[0];
  EXPECT_EQ(buttons.bit_offset, 0u);
  EXPECT_EQ(buttons.bits, 1u);
  EXPECT_EQ(buttons.count, 3u);
  EXPECT_EQ(buttons.usages, (std::vector<UsageRange>{{usage(9, 1), usage(9, 3)}}));
  EXPECT_TRUE(buttons.variable);
  EXPECT_FALSE(buttons.relative);
  const Field& axes = report.fields[1];
  EXPECT_EQ(axes.bit_offset, 8u);
  EXPECT_EQ(axes.logical_minimum, -127);
  EXPECT_EQ(axes.logical_maximum, 127);
  EXPECT_EQ(axes.physical_minimum, -127) << "without a declared physical range, the logical range holds";
  EXPECT_TRUE(axes.relative);
  EXPECT_EQ(axes.collection, 1);
  EXPECT_EQ(axes.find(usage(1, 0x31)), 1u);
  EXPECT_EQ(axes.find(usage(1, 0x32)), std::nullopt);
  EXPECT_TRUE(mouse.is_within(axes.collection, usage(1, 2)));
  EXPECT_FALSE(mouse.is_within(axes.collection, usage(1, 4)));
}

TEST(ReportDescriptor, SeveralTopLevelCollectionsAndIds) {
  Items items;
  items.page(1).begin(4, 1).id(1).use(0x30).logical(0, 1023).size(10, 1).input(2).size(6, 1).input(3).end();
  items.page(1).begin(5, 1).id(2).use(0x30).logical(0, 255).size(8, 1).input(2).id(1).use(0x31).input(2).end();
  const ReportDescriptor two = parsed(items.bytes);
  ASSERT_EQ(two.reports.size(), 2u);
  EXPECT_EQ(two.reports[0].id, 1);
  EXPECT_EQ(two.reports[0].bytes(), 4u) << "id, 10 + 6 bits, and 8 later bits";
  EXPECT_EQ(two.reports[0].fields[1].bit_offset, 16u);
  EXPECT_EQ(two.reports[1].bytes(), 2u);
  EXPECT_EQ(two.find(ReportKind::input, 2), &two.reports[1]);
  EXPECT_EQ(two.find(ReportKind::output, 2), nullptr);
}

TEST(ReportDescriptor, PushAndPopKeepTheGlobals) {
  Items items;
  items.page(1).begin(4, 1).logical(0, 100).size(8, 1).raw({0xa4});
  items.page(9).logical(-1, 1).size(16, 2).use(1).input(2).raw({0xb4}).use(0x30).input(2).end();
  const ReportDescriptor pushed = parsed(items.bytes);
  ASSERT_EQ(pushed.reports.size(), 1u);
  ASSERT_EQ(pushed.reports[0].fields.size(), 2u);
  const Field& after = pushed.reports[0].fields[1];
  EXPECT_EQ(after.usages, (std::vector<UsageRange>{{usage(1, 0x30), usage(1, 0x30)}}));
  EXPECT_EQ(after.logical_maximum, 100);
  EXPECT_EQ(after.bits, 8u);
  EXPECT_EQ(after.count, 1u);
  EXPECT_EQ(after.bit_offset, 32u);
}

TEST(ReportDescriptor, UsagesOfFourBytesIncludeTheirPage) {
  Items items;
  items.page(0x0f).begin(0x57).use(0x000a0001).use(0x000a0002).use(0x52).size(8, 3).logical(0, 255).output(2).end();
  const ReportDescriptor extended = parsed(items.bytes);
  const Field& field = extended.reports.at(0).fields.at(0);
  EXPECT_EQ(field.usage_at(0), usage(0x0a, 1));
  EXPECT_EQ(field.usage_at(1), usage(0x0a, 2));
  EXPECT_EQ(field.usage_at(2), usage(0x0f, 0x52));
  EXPECT_EQ(field.usage_at(3), std::nullopt);
}

TEST(ReportDescriptor, APageAfterTheUsagesIsTheirs) {
  Items items;
  items.page(1).begin(4, 1).raw({0x09, 0x01, 0x09, 0x02, 0x05, 0x09}).logical(0, 1).size(1, 2).input(2);
  items.raw({0x09, 0x03, 0x05, 0x01, 0x09, 0x30}).input(2).end();
  const ReportDescriptor late = parsed(items.bytes);
  EXPECT_EQ(late.reports.at(0).fields.at(0).usage_at(1), usage(9, 2));
  EXPECT_EQ(late.reports.at(0).fields.at(1).usage_at(0), usage(9, 3));
  EXPECT_EQ(late.reports.at(0).fields.at(1).usage_at(1), usage(1, 0x30));
}

TEST(ReportDescriptor, SignsOfRanges) {
  Items items;
  items.page(1).begin(4, 1);
  items.raw({0x15, 0x00, 0x25, 0xff, 0x09, 0x30}).size(8, 1).input(2);               // 255 in one byte
  items.raw({0x16, 0x01, 0x80, 0x26, 0xff, 0x7f, 0x09, 0x31}).size(16, 1).input(2);  // -32767 .. 32767
  items.raw({0x14, 0x27, 0xff, 0xff, 0xff, 0xff, 0x09, 0x32}).size(32, 1).input(2);  // an item without data is 0
  items.raw({0x55, 0x0e}).raw({0x09, 0x33}).input(2).raw({0x55, 0xfd, 0x09, 0x34}).input(2).end();
  const auto fields = parsed(items.bytes).reports.at(0).fields;
  EXPECT_EQ(fields.at(0).logical_maximum, 255);
  EXPECT_EQ(fields.at(1).logical_minimum, -32767);
  EXPECT_EQ(fields.at(1).logical_maximum, 32767);
  EXPECT_EQ(fields.at(2).logical_minimum, 0);
  EXPECT_EQ(fields.at(2).logical_maximum, 4294967295);
  EXPECT_EQ(fields.at(3).unit_exponent, -2);
  EXPECT_EQ(fields.at(4).unit_exponent, -3);
}

TEST(ReportDescriptor, FieldsThatAreArraysHaveAUsageForEachValue) {
  Items items;
  items.page(0x0f).begin(0x78).raw({0x19, 0x79, 0x29, 0x7b}).logical(1, 3).size(8, 1).output(0).end();
  const auto array = parsed(items.bytes).reports.at(0).fields.at(0);
  EXPECT_FALSE(array.variable);
  EXPECT_EQ(array.find(usage(0x0f, 0x7b)), 2u);
  EXPECT_EQ(array.usage_at(1), usage(0x0f, 0x7a));
  EXPECT_EQ(array.usage_at(3), std::nullopt);
}

TEST(ReportDescriptor, FirstOfAlternativeUsagesCounts) {
  Items items;
  items.page(1).begin(4, 1).raw({0xa9, 1}).use(0x30).use(0x32).raw({0xa9, 0}).use(0x31);
  const auto field = parsed(items.logical(0, 1).size(8, 2).input(2).end().bytes).reports.at(0).fields.at(0);
  EXPECT_EQ(field.usage_at(0), usage(1, 0x30));
  EXPECT_EQ(field.usage_at(1), usage(1, 0x31));
}

TEST(ReportDescriptor, LongItemsAreSkipped) {
  Items items;
  items.raw({0xfe, 3, 0xf0, 0xc0, 0xc0, 0xc0}).page(1).begin(4, 1).use(0x30).logical(0, 1).size(8, 1).input(2).end();
  EXPECT_EQ(parsed(items.bytes).reports.size(), 1u);
}

TEST(ReportDescriptor, ErrorsSayWhere) {
  expect_error({0x05}, 0, "an item ends beyond the descriptor");
  expect_error({0x05, 0x01, 0x27, 0, 0, 0}, 2, "an item ends beyond the descriptor");
  expect_error({0xfe, 2, 0, 0}, 0, "a long item ends beyond the descriptor");
  expect_error({0xc0}, 0, "a collection ends that was not begun");
  expect_error({0x05, 0x01, 0xa1, 0x01}, 4, "a collection is not ended");
  expect_error({0xb4}, 0, "popped what was not pushed");
  expect_error({0x85, 0}, 0, "a report id is not in 1 .. 255");
  expect_error({0x09, 1, 0x75, 8, 0x95, 1, 0x81, 2, 0x85, 1}, 8, "a report id comes after fields that have none");
  expect_error({0x09, 1, 0x15, 2, 0x25, 1, 0x75, 8, 0x95, 1, 0x81, 2}, 10, "a logical minimum is above its maximum");
  expect_error({0x76, 1, 1}, 0, "a field has more than 256 bits");
  expect_error({0x77, 0xff, 0xff, 0xff, 0xff}, 0, "a field has more than 256 bits");
  expect_error({0x97, 0xff, 0xff, 0xff, 0xff}, 0, "a field has too many elements");
  expect_error({0x75, 255, 0x96, 0, 0x80, 0x81, 3}, 5, "a report has more than 4096 bytes");
  expect_error({0x19, 3, 0x29, 1}, 2, "a usage minimum is above its maximum");
  expect_error({0x1b, 0, 0, 1, 0, 0x2b, 0, 0, 2, 0}, 5, "a range of usages has two pages");
  expect_error({0xa9, 1, 0xa9, 1}, 2, "a delimiter opens within another");
  expect_error({0xa9, 0}, 0, "a delimiter closes that was not opened");
  expect_error(std::vector<std::uint8_t>(4097), 0, "the descriptor has more than 4096 bytes");
  expect_error(std::vector<std::uint8_t>(17, 0xa4), 16, "too much is pushed");
  expect_error(std::vector<std::uint8_t>(65, 0xa0), 64, "collections stand too deep in one another");
}

TEST(ReportDescriptor, NothingIsNoReport) { EXPECT_TRUE(parsed({}).reports.empty()); }

TEST(ReportDescriptor, AnyCutOrChangeIsAnswered) {
  std::mt19937 random(6);
  for (const test::PidFamily& family : test::all_families()) {
    const auto whole = test::report_descriptor(family);
    for (std::size_t length = 0; length < whole.size(); ++length) {
      (void)parse_report_descriptor(std::span(whole).first(length));
    }
    for (int i = 0; i < 2000; ++i) {
      auto changed = whole;
      changed[random() % changed.size()] = static_cast<std::uint8_t>(random());
      (void)parse_report_descriptor(changed);
    }
  }
}

}  // namespace
}  // namespace wale::hid
