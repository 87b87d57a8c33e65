#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "compiler/text/output_file.hpp"
#include "tests/temporary_folder.hpp"

namespace wale::output_files_test {
namespace {

namespace fs = std::filesystem;

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t entries(const TemporaryFolder& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder / ""), fs::directory_iterator()));
}

TEST(OutputFile, IsOldUntilItIsFinishedAndThenNew) {
  const TemporaryFolder folder;
  const std::string path = folder.write("out", "old");
  {
    auto file = OutputFile::open(path, {});
    ASSERT_TRUE(file);
    file->stream() << std::string(1 << 20, 'n');
    EXPECT_EQ(bytes_of(path), "old");
    ASSERT_TRUE(file->finish());
  }
  EXPECT_EQ(bytes_of(path), std::string(1 << 20, 'n'));
  EXPECT_EQ(entries(folder), 1U);
}

TEST(OutputFile, LeavesNothingBehindThatWasNotFinished) {
  const TemporaryFolder folder;
  {
    auto file = OutputFile::open(folder / "out", {});
    ASSERT_TRUE(file);
    file->stream() << "half";
  }
  EXPECT_EQ(entries(folder), 0U);
}

TEST(OutputFile, HasNoNameUntilItIsWholeSoThatAKilledProcessLeavesNothing) {
  const TemporaryFolder folder;
  const int nameless = open((folder / "").c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
  if (nameless < 0) GTEST_SKIP() << "this file system has no files without a name";
  close(nameless);
  const pid_t child = fork();
  if (child == 0) {
    auto file = OutputFile::open(folder / "out", {});
    file->stream() << std::string(1 << 20, 'h');
    raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(entries(folder), 0U);
}

TEST(OutputFile, KeepsPermissionsAndGivesNewFilesThoseOfTheMask) {
  const TemporaryFolder folder;
  const auto mode_of = [](const std::string& path) {
    struct stat status {};
    EXPECT_EQ(stat(path.c_str(), &status), 0);
    return status.st_mode & 07777;
  };
  const mode_t before = umask(027);
  EXPECT_TRUE(write_file(folder / "new", "text", {}));
  umask(before);
  EXPECT_EQ(mode_of(folder / "new"), 0640U);
  const std::string old = folder.write("old", "text");
  ASSERT_EQ(chmod(old.c_str(), 0751), 0);
  EXPECT_TRUE(write_file(old, "other", {}));
  EXPECT_EQ(mode_of(old), 0751U);
}

TEST(OutputFile, ALinkStaysALink) {
  const TemporaryFolder folder;
  const std::string there = folder.write("there", "old");
  fs::create_symlink("there", folder / "link");
  fs::create_symlink("to_be", folder / "dangling");
  EXPECT_TRUE(write_file(folder / "link", "new", {}));
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(bytes_of(there), "new");
  EXPECT_TRUE(write_file(folder / "dangling", "made", {}));
  EXPECT_TRUE(fs::is_symlink(folder / "dangling"));
  EXPECT_EQ(bytes_of(folder / "to_be"), "made");
}

TEST(OutputFile, IsNoneOfTheInputsByAnyName) {
  const TemporaryFolder folder;
  const std::string input = folder.write("input", "mine");
  fs::create_symlink(input, folder / "soft");
  fs::create_hard_link(input, folder / "hard");
  for (const std::string& name : {input, folder / "soft", folder / "hard", folder / "./input"}) {
    const auto written = write_file(name, "lost", {folder / "missing", input});
    ASSERT_FALSE(written) << name;
    EXPECT_EQ(written.error().code, Code::output_is_input);
    EXPECT_EQ(bytes_of(input), "mine");
  }
  EXPECT_TRUE(write_file(folder / "other", "fine", {input}));
}

TEST(OutputFile, AFullDiskKeepsTheOldFile) {
  const TemporaryFolder folder;
  const std::string path = folder.write("out", "old");
  // A limit on the size of files stands for the disk: the write fails after some of the bytes.
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{100000, 100000};
    setrlimit(RLIMIT_FSIZE, &limit);
    const auto written = write_file(path, std::string(1 << 20, 'n'), {});
    _exit(written ? 1 : written.error().code == Code::unwritable_file ? 0 : 2);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_EQ(bytes_of(path), "old");
  EXPECT_EQ(entries(folder), 1U);
}

TEST(OutputFile, StreamsGoOutAsTheyCome) {
  const TemporaryFolder folder;
  ASSERT_EQ(mkfifo((folder / "fifo").c_str(), 0600), 0);
  std::string read;
  std::thread reader([&] { read = bytes_of(folder / "fifo"); });
  EXPECT_TRUE(write_file(folder / "fifo", std::string(200000, 'f'), {}));
  reader.join();
  EXPECT_EQ(read, std::string(200000, 'f'));
  EXPECT_TRUE(write_file("/dev/null", "gone", {}));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  const auto full = write_file("/dev/full", "text", {});
  ASSERT_FALSE(full);
  EXPECT_EQ(full.error().sentence, "cannot write this file: No space left on device");
}

TEST(OutputFile, AnOpenDescriptorIsWrittenWhereItStands) {
  const TemporaryFolder folder;
  const int descriptor = open((folder / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  ASSERT_GE(descriptor, 0);
  ASSERT_EQ(write(descriptor, "one ", 4), 4);
  for (const std::string& name :
       {"/dev/fd/" + std::to_string(descriptor), "/proc/self/fd/" + std::to_string(descriptor)})
    EXPECT_TRUE(write_file(name, "two ", {}));
  close(descriptor);
  EXPECT_EQ(bytes_of(folder / "log"), "one two two ");
}

TEST(OutputFile, WhatCannotBeWrittenIsTold) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "sub");
  const auto sentence = [](const Result<>& result) { return result ? "" : result.error().sentence; };
  EXPECT_EQ(sentence(write_file(folder / "sub", "", {})), "cannot write this file: Is a directory");
  EXPECT_EQ(sentence(write_file(folder / "no/out", "", {})), "cannot write this file: there is no such folder");
  EXPECT_EQ(sentence(write_file("", "", {})), "cannot write this file: No such file or directory");
  EXPECT_EQ(sentence(replace_file(folder / "no", "")), "cannot write this file: No such file or directory");
  EXPECT_EQ(sentence(replace_file("/dev/null", "")), "cannot write this file: it is not a regular file");
}

}  // namespace
}  // namespace wale::output_files_test
