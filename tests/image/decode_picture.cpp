// Hostile pictures and hostile decoders: the process that asks for heights gets them, or an error, and is not
// disturbed.

#include "compiler/image/decode_picture.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <seccomp.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <thread>

#include "compiler/image/decoder/sandbox.hpp"
#include "tests/image/encoding.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::decode_picture_test {
namespace {

/// The memory of the largest child so far, in bytes.
long long largest_child() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return 1024LL * usage.ru_maxrss;
}

/// The processor time of all children so far, in seconds.
double children_seconds() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Bytes small_picture() {
  return encode("png", OIIO::ImageSpec(16, 8, 1, OIIO::TypeUInt16), ramp<std::uint16_t>(16 * 8));
}

void append(Bytes& bytes, std::string_view text) {
  for (const char c : text) bytes.push_back(static_cast<std::byte>(c));
}

void append_big_endian(Bytes& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes.push_back(static_cast<std::byte>(value >> shift));
}

std::uint32_t crc_of(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const std::byte byte : bytes) {
    crc ^= std::to_integer<std::uint32_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

void append_chunk(Bytes& png, std::string_view kind, std::span<const std::byte> data) {
  append_big_endian(png, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = png.size();
  append(png, kind);
  png.insert(png.end(), data.begin(), data.end());
  append_big_endian(png, crc_of(std::span(png).subspan(begin)));
}

/// A whole header of a PNG of 16 bits in four channels, and a beginning of its pixels.
Bytes declared_png(std::uint32_t side) {
  Bytes png, header;
  append(png, std::string_view("\x89PNG\r\n\x1a\n", 8));
  append_big_endian(header, side);
  append_big_endian(header, side);
  append(header, std::string_view("\x10\x06\0\0\0", 5));
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", std::as_bytes(std::span("\x78\x9c\x63", 3)));
  return png;
}

/// A small picture of such a format whose header then declares another size, as two numbers of 32 bits.
Bytes redeclared(const std::string& extension, std::string_view before, std::size_t between, std::uint32_t width,
                 std::uint32_t height) {
  Bytes file = encode(extension, OIIO::ImageSpec(40, 40, 3, OIIO::TypeHalf), std::vector<float>(40 * 40 * 3, 0.5f));
  const std::string_view text(reinterpret_cast<const char*>(file.data()), file.size());
  const std::size_t at = text.find(before);
  EXPECT_NE(at, std::string_view::npos);
  std::memcpy(&file[at + before.size()], &width, 4);
  std::memcpy(&file[at + before.size() + between], &height, 4);
  return file;
}

// On a system without this limit 2^28 pixels were read: 87 s and 1.3 GB.
TEST(HostilePictures, MorePixelsThanAPatchCanUseAreRefusedByTheirHeader) {
  for (const std::uint32_t side : {4097u, 16384u, 0x7fffffffu}) {
    const auto image = read_height_image(declared_png(side), "a.png", 0);
    ASSERT_FALSE(image);
    if (side > 1'000'000) continue;  // the format's own library refuses it
    EXPECT_EQ(image.error().code, Code::image_size);
    EXPECT_NE(image.error().sentence.find(std::to_string(side) + " x " + std::to_string(side)), std::string::npos);
  }
  using namespace std::string_view_literals;
  // xMax and yMax of the window of data; xMin and yMin are 0.
  const Bytes exr = redeclared("exr", "dataWindow\0box2i\0\x10\0\0\0\0\0\0\0\0\0\0\0"sv, 4, 99'999, 99'999);
  const auto image = read_height_image(exr, "a.exr", 0);
  ASSERT_FALSE(image);
  EXPECT_TRUE(image.error().code == Code::image_size || image.error().code == Code::unreadable_image);
  // A TIFF's tags of width and height: short or long numbers, one value each.
  Bytes tiff = encode("tif", OIIO::ImageSpec(40, 40, 1, OIIO::TypeUInt8), ramp<std::uint8_t>(1600));
  const std::uint32_t vast = 1'000'000;  // as one plane of 8 bits, 0.9 TB
  for (std::size_t at = 8; at + 12 <= tiff.size(); ++at) {
    std::uint16_t tag = 0, type = 0;
    std::uint32_t count = 0;
    std::memcpy(&tag, &tiff[at], 2), std::memcpy(&type, &tiff[at + 2], 2), std::memcpy(&count, &tiff[at + 4], 4);
    if ((tag != 256 && tag != 257) || count != 1 || (type != 3 && type != 4)) continue;
    tiff[at + 2] = std::byte{4};
    std::memcpy(&tiff[at + 8], &vast, 4);
  }
  const auto of_tiff = read_height_image(tiff, "a.tif", 0);
  ASSERT_FALSE(of_tiff);
  EXPECT_EQ(of_tiff.error().code, Code::image_size) << of_tiff.error().sentence;
}

TEST(HostilePictures, TheLargestPictureStaysWithinItsMemoryAndTime) {
  // Interlaced or in one piece, decoders hold more than a row: a single strip of 4096 x 4096 pixels.
  OIIO::ImageSpec spec(4096, 4096, 3, OIIO::TypeUInt8);
  spec.attribute("tiff:RowsPerStrip", 4096);
  spec.attribute("compression", "zip");
  const Bytes file = encode("tif", spec, std::vector<std::uint8_t>(std::size_t{4096} * 4096 * 3, 128));
  EXPECT_LT(file.size(), 1u << 20) << "a bomb is small";
  const double before = children_seconds();
  const auto image = read_height_image(file, "a.tif", 0);
  ASSERT_TRUE(image) << image.error().sentence;
  EXPECT_EQ(image->table.width, 4096u);
  EXPECT_EQ(image->table.heights[5'000'000], 128 * 257);
  EXPECT_LT(largest_child(), static_cast<long long>(decoder::most_memory));
  EXPECT_LE(children_seconds() - before, decoder::most_processor_seconds + 1);
}

TEST(HostilePictures, FilesWithMoreBytesThanAnyPictureAreRefused) {
  const auto image = read_height_image(Bytes(largest_asset + 1), "a.png", 0);
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, Code::unreadable_image);
  EXPECT_EQ(image.error().sentence, "the file has 257 MB, and pictures of up to 257 MB are read");
}

/// A program in the place of the decoder.
class FakeDecoder {
 public:
  explicit FakeDecoder(const std::string& commands) {
    path_ = folder_.write("decoder", "#!/bin/sh\n" + commands + "\n");
    ::chmod(path_.c_str(), 0755);
  }
  Result<HeightImage> decode() const { return decode_picture(small_picture(), {"png", 0, Sandbox::required}, {path_}); }
  std::string problem() const {
    const auto image = decode();
    if (image) return "decoded";
    EXPECT_EQ(image.error().code, Code::unreadable_image);
    return image.error().sentence;
  }

 private:
  TemporaryFolder folder_;
  std::string path_;
};

TEST(HostileDecoders, EveryEndIsAnError) {
  EXPECT_EQ(FakeDecoder("kill -SEGV $$").problem(),
            "the decoder crashed, on this picture or for want of memory or of threads");
  EXPECT_EQ(FakeDecoder("kill -ABRT $$").problem(),
            "the decoder crashed, on this picture or for want of memory or of threads");
  EXPECT_EQ(FakeDecoder("kill -XCPU $$").problem(), "the picture takes more than 10 s of processor time to decode");
  EXPECT_EQ(FakeDecoder("exit 0").problem(), "the decoder gave no valid answer");
  EXPECT_EQ(FakeDecoder("echo WADR nonsense").problem(), "the decoder gave no valid answer");
  // It is killed as soon as it has written more than an answer can have.
  EXPECT_EQ(FakeDecoder("exec cat /dev/zero").problem(), "the decoder gave no valid answer");
  // It is not waited for once it has closed its answer.
  EXPECT_EQ(FakeDecoder("exec >&-; exec sleep 1000").problem(), "the decoder gave no valid answer");
  EXPECT_EQ(FakeDecoder("exit 127").decode().error().code, Code::missing_library);
  const auto missing = decode_picture(small_picture(), {}, {"/nowhere/wale-decoder"});
  EXPECT_EQ(missing.error().code, Code::missing_library);
  EXPECT_EQ(missing.error().place.name, "wale-decoder");
}

TEST(HostileDecoders, GetThePictureAndNothingElse) {
  const int leaking = open("/dev/null", O_RDONLY);  // of an application that forgot O_CLOEXEC
  setenv("WALE_TEST_SECRET", "secret", 1);
  // Of descriptors only the first three are open, and the one of the list itself; the picture cannot be written to.
  const std::string checks =
      "[ -z \"$WALE_TEST_SECRET$HOME\" ] || exit 1\n"
      "for each in /proc/$$/fd/*; do case $each in */0|*/1|*/2|*/10|*/255) ;; *) [ -e $each ] && exit 2;; esac; done\n"
      "[ \"$*\" = 'png 0 required heights' ] || exit 3\n"
      "echo changed 2>/dev/null >&0 && exit 4\n"
      "kill -XCPU $$";
  EXPECT_EQ(FakeDecoder(checks).problem(), "the picture takes more than 10 s of processor time to decode");
  unsetenv("WALE_TEST_SECRET");
  close(leaking);
}

TEST(Application, KeepsItsChildrenAndSignals) {
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "a decoder is left over";
  // An application that wants no news of its children loses them before anybody can wait for them.
  const auto before = signal(SIGCHLD, SIG_IGN);
  EXPECT_TRUE(decode_picture(small_picture(), {"png", 0, Sandbox::required}));
  EXPECT_EQ(signal(SIGCHLD, before), SIG_IGN) << "the handler has been changed";
  const pid_t other = fork();
  if (other == 0) _exit(7);
  EXPECT_TRUE(decode_picture(small_picture(), {"png", 0, Sandbox::required}));
  int status = 0;
  EXPECT_EQ(waitpid(other, &status, 0), other) << "another child has been taken";
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(Application, NeedsNoStandardStreams) {
  const pid_t child = fork();
  if (child == 0) {
    for (int descriptor = 0; descriptor < 3; ++descriptor) close(descriptor);
    const auto image = decode_picture(small_picture(), {"png", 0, Sandbox::required});
    _exit(image && image->table.heights.size() == 16 * 8 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
}

TEST(Application, MayAskFromSeveralThreads) {
  std::atomic<int> decoded = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      decoded += decode_picture(small_picture(), {"png", 0, Sandbox::required}).has_value();
    });
  for (std::thread& each : threads) each.join();
  EXPECT_EQ(decoded, 3);
}

/// Runs `body` where the system lets nobody install a filter, as in some containers.
template <class Body>
void without_seccomp(Body body) {
  std::thread([&] {
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ALLOW);
    seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(seccomp), 0);
    seccomp_rule_add(filter, SCMP_ACT_ERRNO(EPERM), SCMP_SYS(prctl), 1, SCMP_A0(SCMP_CMP_EQ, PR_SET_SECCOMP));
    ASSERT_EQ(seccomp_load(filter), 0);
    seccomp_release(filter);
    body();
  }).join();
}

TEST(WithoutSandbox, PicturesAreRefusedUnlessAskedFor) {
  without_seccomp([] {
    const auto refused = read_height_image(small_picture(), "other.png", 0.25);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, Code::no_sandbox);
    EXPECT_NE(refused.error().mend.find("--unsandboxed-pictures"), std::string::npos);
    EXPECT_EQ(refused.error().place.name, "other.png");
    const auto trusted = read_height_image(small_picture(), "other.png", 0.25, Sandbox::if_possible);
    ASSERT_TRUE(trusted) << trusted.error().sentence;
    EXPECT_EQ(trusted->table.heights.size(), 16u * 8u);
  });
}

TEST(Answers, ComeBackAsTheyWere) {
  const HeightImage image{{5, 4, std::vector<std::uint16_t>(20, 12345)}, 1.5, 2};
  const auto back = read_answer(write_answer(image));
  ASSERT_TRUE(back && *back);
  EXPECT_EQ((*back)->table, image.table);
  EXPECT_EQ((*back)->pixels_per_column, 1.5);
  EXPECT_EQ((*back)->pixels_per_row, 2);
  const auto error = read_answer(write_answer(Error{Code::image_size, "a\x1b[2Jb\nc\xc3\xa9", "mend it"}));
  ASSERT_TRUE(error && !*error);
  EXPECT_EQ(error->error().code, Code::image_size);
  EXPECT_EQ(error->error().sentence, "a?[2Jb?c??") << "a terminal must not get what a picture may have written";
  EXPECT_EQ(error->error().mend, "mend it");
  EXPECT_EQ(read_answer(write_answer(Error{Code::absent_device, "x"}))->error().code, Code::unreadable_image);
}

TEST(Answers, ThatAreNotWholeAreNone) {
  const Bytes whole = write_answer(HeightImage{{5, 4, std::vector<std::uint16_t>(20, 1)}, 1, 1});
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(read_answer(std::span(whole).first(size))) << size;
  Bytes longer = whole;
  longer.push_back({});
  EXPECT_FALSE(read_answer(longer));
  for (const auto& [width, height] : {std::pair{0u, 0u}, {3u, 7u}, {4097u, 4u}, {0x80000000u, 2u}, {5u, 5u}}) {
    Bytes forged = whole;
    std::memcpy(&forged[8], &width, 4), std::memcpy(&forged[12], &height, 4);
    EXPECT_FALSE(read_answer(forged)) << width << " x " << height;
  }
  for (const double scale : {0.0, -1.0, 0.5, 1e300, std::nan(""), HUGE_VAL}) {
    Bytes forged = whole;
    std::memcpy(&forged[16], &scale, 8);
    EXPECT_FALSE(read_answer(forged)) << scale;
  }
}

}  // namespace
}  // namespace wale::decode_picture_test
