// Files that are no regular files, given to every verb that reads one, and the pictures that files name.

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "tests/command_line/running.hpp"

namespace wale::command_line {
namespace {

/// The words of a verb that reads `file`.
std::vector<std::vector<std::string>> readers_of(const std::string& file, const TemporaryFolder& folder) {
  return {{"check", file},
          {"check", "--fix", file},
          {"format", file},
          {"format", "--check", file},
          {"build", file, "-o", folder / "out.wpp"},
          {"build", file, "--all", "-o", folder / "out"},
          {"build", file, "--emit", "cpp"},
          {"describe", file},
          {"preview", file, "-o", folder / "out.png"},
          {"compare", file, corduroy},
          {"feel", file, "--virtual-time", "--seconds", "0.1"},
          {"sample", file, "--at", "0 mm, 0 mm"},
          {"sample", corduroy, "--trace", file},
          {"replay", file},
          {"calibrate", "fit", file},
          {"calibrate", "fit", "--stimuli", file, "--task", "magnitude_estimation", "--size", "x",
           folder.write("trials.csv", "participant,trial,x,response\nA,1,1,1\n")},
          {"calibrate", "device", "--device", "simulated", "--table", file}};
}

TEST(Inputs, ThatAreNoRegularFilesAreErrorsAtOnce) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe.wale", subfolder = folder / "folder.wale";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  fs::create_directory(subfolder);
  const struct {
    std::string file, said;
  } inputs[] = {{pipe, "pipe"}, {subfolder, "folder"}, {"/dev/zero", "device"}, {"/dev/null", "device"}};
  for (const auto& [file, said] : inputs)
    for (const auto& words : readers_of(file, folder)) {
      const Outcome outcome = wale(words);
      EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words) << outcome.err;
      EXPECT_TRUE(contains(outcome.out + outcome.err, "W0501")) << testing::PrintToString(words) << outcome.err;
      EXPECT_TRUE(contains(outcome.out + outcome.err, "this is a " + said))
          << testing::PrintToString(words) << outcome.out << outcome.err;
      EXPECT_FALSE(fs::exists(folder / "out.wpp"));
    }
}

/// A material that shows a file as its relief.
std::string showing(const TemporaryFolder& folder, const std::string& picture) {
  return folder.write("shown.wale", "wale 1\n\nmaterial shown {\n  physical {\n    height face = image(\"" + picture +
                                        "\", scale: 0.5 mm/px, height: 2 mm)\n"
                                        "    force = lateral(face, amplitude: 1 N)\n  }\n}\n");
}

TEST(Inputs, PicturesAndImportsThatAreNoRegularFilesAreDiagnostics) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "pipe.png").c_str(), 0600), 0);
  ASSERT_EQ(mkfifo((folder / "pipe.wale").c_str(), 0600), 0);
  const Outcome of_picture = wale({"check", showing(folder, "pipe.png")});
  EXPECT_EQ(of_picture.status, 1);
  EXPECT_TRUE(contains(of_picture.out, "error[W0501]: `pipe.png` cannot be read: this is a pipe")) << of_picture.out;
  const Outcome of_import = wale({"check", folder.write("a.wale", "wale 1\nimport pipe\n")});
  EXPECT_EQ(of_import.status, 1);
  EXPECT_TRUE(contains(of_import.out, "this is a pipe")) << of_import.out;
}

// What the loader of shared libraries says of a process says nothing of the decoder, which gets no environment.
TEST(Pictures, AreDecodedByAnotherProcess) {
  const TemporaryFolder folder;
  folder.write("slate.png", bytes_of(std::string(WALE_SOURCE_DIR) + "/library/stone/slate.png"));
  testing::internal::CaptureStderr();  // of the shell, whose libraries are of no interest
  setenv("LD_DEBUG", "files", 1);
  const Outcome outcome = wale({"build", showing(folder, "slate.png"), "-o", folder / "out.wpp"});
  unsetenv("LD_DEBUG");
  testing::internal::GetCapturedStderr();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(contains(outcome.err, "libc.so")) << "the loader says nothing here";
  EXPECT_FALSE(contains(outcome.err, "OpenImageIO"));
  EXPECT_GT(fs::file_size(folder / "out.wpp"), 1000u);
}

TEST(Pictures, MayBeDecodedWithoutSandboxByAnOption) {
  const TemporaryFolder folder;
  folder.write("slate.png", bytes_of(std::string(WALE_SOURCE_DIR) + "/library/stone/slate.png"));
  const std::string file = showing(folder, "slate.png");
  const Outcome with = wale({"build", file, "-o", folder / "with.wpp"});
  const Outcome without = wale({"build", file, "--unsandboxed-pictures", "-o", folder / "without.wpp"});
  EXPECT_EQ(with.status, 0) << with.err;
  EXPECT_EQ(without.status, 0) << without.err;
  EXPECT_EQ(bytes_of(folder / "with.wpp"), bytes_of(folder / "without.wpp"));
  for (const char* verb : {"check", "build", "describe", "preview", "compare", "feel", "sample"})
    EXPECT_TRUE(contains(wale({verb, "--help"}).out, "--unsandboxed-pictures")) << verb;
}

}  // namespace
}  // namespace wale::command_line
