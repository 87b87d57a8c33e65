#include "runtime/device/falcon/falcon_packets.hpp"

#include <gtest/gtest.h>

#include <string>

namespace wale::test::falcon_packets {
namespace {

using namespace falcon;

std::string text_of(const Command& command) {
  const Packet packet = encode(command);
  return std::string(packet.begin(), packet.end());
}

std::vector<Answer> read(const std::string& text, AnswerReader& reader) {
  std::vector<Answer> answers;
  for (const char byte : text) {
    if (const auto answer = reader.take(static_cast<std::uint8_t>(byte))) answers.push_back(*answer);
  }
  return answers;
}

std::vector<Answer> read(const std::string& text) {
  AnswerReader reader;
  return read(text, reader);
}

TEST(FalconPackets, ACommandEncodesNibblesFromTheLetterA) {
  // tests/reference/usb_exchanges.md and FalconFirmwareNovintSDK.h: least significant nibble first, each plus 0x41.
  EXPECT_EQ(text_of({{0, 0, 0}, false}), "<AAAAAAAAAAAAAA>");
  EXPECT_EQ(text_of({{0, 0, 0}, true}), "<AAAAAAAAAAAABA>");
  EXPECT_EQ(text_of({{1, -1, 0x0123}, false}), "<BAAAPPPPDCBAAA>");
  EXPECT_EQ(text_of({{-1447, 0, 0}, true, Light::green}), "<JFKPAAAAAAAAFA>");
}

TEST(FalconPackets, TorquesAreCapped) {
  EXPECT_EQ(text_of({{4096, 4097, 32767}, false}), "<AAABAAABAAABAA>");
  EXPECT_EQ(text_of({{-4096, -4097, -32768}, false}), "<AAAPAAAPAAAPAA>");
}

TEST(FalconPackets, AnAnswerHasEncodersButtonsAndHomedFlags) {
  // The header's own example: JFKP is FA59 hexadecimal, -1447 in sixteen bits.
  EXPECT_EQ(read("<JFKPAAAAPPPHAA>"), (std::vector<Answer>{{{-1447, 0, 32767}, 0, 0}}));
  const char all = static_cast<char>(0x41 + 0x70 + 0x05);
  const auto homed = read(std::string("<AAAAAAAAAAAA") + all + "A>");
  ASSERT_EQ(homed.size(), 1u);
  EXPECT_EQ(homed[0].buttons, 5);
  EXPECT_TRUE(homed[0].is_homed());
  EXPECT_FALSE(read(std::string("<AAAAAAAAAAAA") + static_cast<char>(0x41 + 0x30) + "A>")[0].is_homed());
}

TEST(FalconPackets, OtherBytesThanAnswersAreSkipped) {
  AnswerReader reader;
  EXPECT_EQ(read("xy<AAAA", reader).size(), 0u);
  EXPECT_EQ(reader.skipped(), 2);
  EXPECT_EQ(read("<BAAAAAAAAAAAAA>", reader).size(), 1u) << "a truncated answer, then a whole one";
  EXPECT_EQ(reader.skipped(), 7);
  EXPECT_EQ(read("<AAAAAAAQAAAAAA>", reader).size(), 0u) << "Q is no nibble";
  EXPECT_EQ(read("<AAAAAAAAAAAAAA?", reader).size(), 0u);
  EXPECT_EQ(reader.skipped(), 39);
  EXPECT_EQ(read("<AAAAAAAAAAAAAA><CAAAAAAAAAAAAA>", reader).size(), 2u);
}

TEST(FalconPackets, TheChipsStatusBytesAreLeftOut) {
  const std::uint8_t bytes[] = {0x01, 0x60, '<', 'A'};
  EXPECT_EQ(payload(bytes).size(), 2u);
  EXPECT_EQ(payload(bytes)[0], '<');
  EXPECT_TRUE(payload(std::span(bytes).first(2)).empty());
  EXPECT_TRUE(payload(std::span(bytes).first(1)).empty());
}

}  // namespace
}  // namespace wale::test::falcon_packets
