// Every verb with an output that cannot be written: standard output that is full, closed, or a pipe whose reader has
// gone; files in a folder that may not be written, on a disk that is full, or that are inputs; folders, pipes and
// devices. The status and the message are those of compiler/README.md, and no input changes.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/capability.h>
#include <signal.h>
#include <sys/mount.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tests/command_line/running.hpp"

namespace wale::command_line::outputs_test {
namespace {

using Words = std::vector<std::string>;

/// Runs `wale` with what `prepare` does to its process first. Standard output and standard error go to files of the
/// folder, unless `prepare` leads them elsewhere.
Outcome wale_after(const std::function<void()>& prepare, Words words, const std::string& typed = "/dev/null") {
  const TemporaryFolder folder;
  const std::string out = folder / "out", err = folder / "err";
  const pid_t child = fork();
  if (child == 0) {
    setenv("XDG_CONFIG_HOME", "/nonexistent", 1);
    dup2(open(typed.c_str(), O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
    prepare();
    words.insert(words.begin(), WALE_BINARY);
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(WALE_BINARY, arguments.data());
    _exit(127);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), bytes_of(out), bytes_of(err)};
}

void leave_as_it_is() {}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

/// The files that verbs read.
struct Inputs {
  TemporaryFolder folder;
  std::string own, untidy, trace, run, typed;

  Inputs() {
    own = folder.write("own.wale", bytes_of(corduroy));
    untidy = folder.write("untidy.wale", "wale 1\nmaterial   untidy { perceptual { roughness 0.5 } }\n");
    trace = folder.write("trace.csv", "t,x,y\n0,0,0\n0.001,0.001,0\n");
    run = folder / "run.wrec";
    typed = folder.write("typed", "1\n");
    EXPECT_EQ(wale({"feel", own, "--virtual-time", "--seconds", "0.2", "--record", run}).status, 0);
  }
  std::map<std::string, std::string> bytes() const {
    std::map<std::string, std::string> all;
    for (const auto& each : fs::directory_iterator(folder.path()))
      if (each.is_regular_file()) all[each.path()] = bytes_of(each.path());
    return all;
  }
};

/// What is typed for a command of `printing`.
const std::string& typed_for(const Words& words, const Inputs& in) {
  return words[0] == "format" ? in.untidy : in.typed;
}

/// Every verb as it prints on standard output.
std::vector<Words> printing(const Inputs& in) {
  const Words quick{"--virtual-time", "--seconds", "0.1"};
  return {{"--help"},
          {"--version"},
          {"feel", "--help"},
          {"check", in.own},
          {"check", in.own, "--json"},
          {"explain"},
          {"explain", "W0301"},
          {"format", "--check", in.untidy},
          {"format", "-"},
          {"build", in.own, "--emit", "tree"},
          {"build", in.own, "--emit", "cpp", "-o", "/dev/stdout"},
          {"build", in.own, "--all", "-o", in.folder / "all"},
          {"describe", in.own},
          {"describe", in.own, "--json"},
          {"describe", in.own, "--exports"},
          {"describe", in.own, "--device", "all"},
          {"find", "corduroy"},
          {"find", "corduroy", "--json"},
          {"compare", in.own, in.untidy},
          {"compare", in.own, in.untidy, "--json"},
          {"levels", "roughness"},
          {"levels", "roughness", "--json"},
          {"feel", in.own, quick[0], quick[1], quick[2]},
          {"feel", in.own, quick[0], quick[1], quick[2], "--json"},
          {"feel", in.own, "--against", "denim", "--blind", "--trials", "1", "--seed", "1", "--device", "simulated",
           "--seconds", "0.1"},
          {"replay", in.run},
          {"replay", in.run, "--json"},
          {"replay", in.run, "--csv", "-"},
          {"sample", in.own, "--at", "1 mm, 0 mm"},
          {"sample", in.own, "--trace", in.trace, "--json"},
          {"devices"},
          {"devices", "--json"}};
}

TEST(StandardOutput, ThatCannotBeWrittenIsToldOnceAndIsStatus1) {
  const Inputs in;
  const struct {
    std::function<void()> prepare;
    std::string why;
  } ways[] = {{[] { dup2(open("/dev/full", O_WRONLY), STDOUT_FILENO); }, "No space left on device"},
              {[] { close(STDOUT_FILENO); }, "it is closed"}};
  for (const Words& words : printing(in)) {
    const Outcome usual = wale_after(leave_as_it_is, words, typed_for(words, in));
    ASSERT_FALSE(usual.out.empty()) << testing::PrintToString(words) << usual.err;
    const auto before = in.bytes();
    for (const auto& [prepare, why] : ways) {
      const Outcome outcome = wale_after(prepare, words, typed_for(words, in));
      EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words) << why << outcome.err;
      EXPECT_EQ(count(outcome.err, "wale: error[W0505]: cannot write to standard output: " + why + "\n"), 1u)
          << testing::PrintToString(words) << outcome.err;
      EXPECT_EQ(in.bytes(), before) << testing::PrintToString(words);
    }
  }
}

TEST(StandardOutput, WhoseReaderHasGoneIsQuietAndStatus1) {
  const Inputs in;
  for (const Words& words : printing(in)) {
    const Outcome usual = wale_after(leave_as_it_is, words, typed_for(words, in));
    for (const auto handler : {SIG_IGN, SIG_DFL}) {
      const auto leave_no_reader = [handler] {
        signal(SIGPIPE, handler);
        int ends[2];
        if (pipe(ends) != 0) _exit(126);
        close(ends[0]);
        dup2(ends[1], STDOUT_FILENO);
      };
      const Outcome outcome = wale_after(leave_no_reader, words, typed_for(words, in));
      EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words) << outcome.err;
      EXPECT_EQ(outcome.err, usual.err) << testing::PrintToString(words);
    }
  }
}

TEST(StandardOutput, IsNotNeededByACommandThatPrintsNothing) {
  const Inputs in;
  const auto closed = [] { close(STDIN_FILENO), close(STDOUT_FILENO), close(STDERR_FILENO); };
  EXPECT_EQ(wale_after(closed, {"build", in.own, "-o", in.folder / "out.wpp"}).status, 0);
  EXPECT_EQ(wale({"describe", in.folder / "out.wpp"}).status, 0) << "no output of another kind got into the file";
}

TEST(StandardError, ThatIsClosedOrFullChangesNoStatus) {
  const Inputs in;
  for (const auto& prepare :
       {+[] { close(STDERR_FILENO); }, +[] { dup2(open("/dev/full", O_WRONLY), STDERR_FILENO); }}) {
    EXPECT_EQ(wale_after(prepare, {"describe", in.own}).status, 0);
    EXPECT_EQ(wale_after(prepare, {"describe", "nothing.wale"}).status, 1);
    EXPECT_EQ(wale_after(prepare, {"describe", in.own, "--device", "nothing"}).status, 2);
  }
}

/// A verb that writes a file.
struct Writing {
  std::string suffix;  ///< of the file
  std::function<Words(const Inputs&, const std::string& file)> words;
};

std::vector<Writing> writing() {
  const auto feel = [](const Inputs& in, const std::string& file) -> Words {
    return {"feel", in.own, "--virtual-time", "--seconds", "0.1", "--record", file};
  };
  return {
      {".wpp",
       [](const Inputs& in, const std::string& file) -> Words {
         return {"build", in.own, "-o", file};
       }},
      {".cpp",
       [](const Inputs& in, const std::string& file) -> Words {
         return {"build", in.own, "--emit", "cpp", "-o", file};
       }},
      {".png",
       [](const Inputs& in, const std::string& file) -> Words {
         return {"preview", in.own, "-o", file};
       }},
      {".csv",
       [](const Inputs& in, const std::string& file) -> Words {
         return {"sample", in.own, "--trace", in.trace, "-o", file};
       }},
      {".csv", feel},
      {".wrec", feel},
      {".csv",
       [](const Inputs& in, const std::string& file) -> Words {
         return {"replay", in.run, "--csv", file};
       }},
      {".wav",
       [](const Inputs& in, const std::string& file) -> Words {
         return {"replay", in.run, "--wav", file};
       }},
      {".wale",
       [](const Inputs&, const std::string& file) -> Words {
         return {"format", file};
       }},
      {".wale",
       [](const Inputs&, const std::string& file) -> Words {
         return {"check", "--fix", file};
       }},
  };
}

/// What `format` and `check --fix` change in place.
const std::string mendable = "wale 1\nmaterial   own { perceptual { roughnes 0.5 } }\n";
bool is_in_place(const Writing& verb) { return verb.suffix == ".wale"; }

/// What stands in the file before; a recording never overwrites one.
std::string old_content(const Writing& verb) {
  return is_in_place(verb) ? mendable : verb.suffix == ".wrec" ? "" : "old";
}

/// Whether a command failed as one that could not write: its status, its message, and nothing left behind.
void expect_unwritten(const Outcome& outcome, const Words& words, const std::string& code) {
  EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words) << outcome.out << outcome.err;
  EXPECT_EQ(count(outcome.err, "[" + code + "]"), 1u) << testing::PrintToString(words) << outcome.err;
}

TEST(OutputFiles, InAFolderThatMayNotBeWrittenAreTold) {
  // The right of root to write everywhere is given up first.
  const auto as_anybody = [] { prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE); };
  for (const Writing& verb : writing()) {
    const Inputs in;
    const TemporaryFolder closed;
    const std::string file = closed / ("out" + verb.suffix);
    if (is_in_place(verb)) closed.write("out.wale", mendable);
    chmod(closed.path().c_str(), 0500);
    const Words words = verb.words(in, file);
    const auto before = in.bytes();
    const Outcome outcome = wale_after(as_anybody, words);
    const bool is_made = fs::exists(file) && !is_in_place(verb);
    chmod(closed.path().c_str(), 0700);
    ASSERT_FALSE(is_made) << "root could not give up its rights";
    expect_unwritten(outcome, words, "W0505");
    EXPECT_TRUE(contains(outcome.err, file)) << outcome.err;
    EXPECT_EQ(in.bytes(), before);
    EXPECT_EQ(bytes_of(file), is_in_place(verb) ? mendable : "");
    EXPECT_EQ(std::distance(fs::directory_iterator(closed.path()), {}), is_in_place(verb) ? 1 : 0);
  }
}

TEST(OutputFiles, ThatMayNotGrowAreToldAndTheOldOnesKept) {
  for (const Writing& verb : writing())
    for (const auto handler : {SIG_IGN, SIG_DFL}) {
      const Inputs in;
      const TemporaryFolder folder;
      const std::string file = folder / ("out" + verb.suffix), old = old_content(verb);
      if (!old.empty()) folder.write("out" + verb.suffix, old);
      const Words words = verb.words(in, file);
      const auto before = in.bytes();
      const auto allow_few_bytes = [handler] {
        signal(SIGXFSZ, handler);
        const rlimit few{1, 1};
        const int err = open("/dev/null", O_WRONLY);
        setrlimit(RLIMIT_FSIZE, &few);
        dup2(err, STDOUT_FILENO), dup2(err, STDERR_FILENO);  // these files may not grow either
      };
      const Outcome outcome = wale_after(allow_few_bytes, words);
      EXPECT_EQ(outcome.status, 1) << testing::PrintToString(words);
      EXPECT_EQ(in.bytes(), before);
      EXPECT_EQ(bytes_of(file), old) << testing::PrintToString(words);
      EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), old.empty() ? 0 : 1)
          << testing::PrintToString(words);
    }
}

TEST(OutputFiles, OnADiskThatIsFullAreToldAndTheOldOnesKept) {
  const TemporaryFolder disk;
  if (mount("tmpfs", disk.path().c_str(), "tmpfs", 0, "size=4k") != 0)
    GTEST_SKIP() << "no file system may be mounted here: " << std::strerror(errno);
  const struct Unmounted {
    const TemporaryFolder& disk;
    ~Unmounted() { umount(disk.path().c_str()); }
  } at_the_end{disk};
  for (const Writing& verb : writing()) {
    const Inputs in;
    const std::string file = disk / ("out" + verb.suffix), old = old_content(verb);
    if (!old.empty()) disk.write("out" + verb.suffix, old);
    ASSERT_EQ(bytes_of(file), old);
    const Words words = verb.words(in, file);
    const auto before = in.bytes();
    const Outcome outcome = wale_after(leave_as_it_is, words);
    expect_unwritten(outcome, words, "W0505");
    EXPECT_TRUE(contains(outcome.err, "No space left on device") || contains(outcome.err, "the disk is full"));
    EXPECT_EQ(in.bytes(), before);
    EXPECT_EQ(bytes_of(file), old) << testing::PrintToString(words);
    EXPECT_EQ(std::distance(fs::directory_iterator(disk.path()), {}), old.empty() ? 0 : 1)
        << testing::PrintToString(words);
    fs::remove(file);
  }
}

TEST(OutputFiles, ThatAreInputsAreRefusedByWhateverName) {
  const Inputs in;
  const std::string link = in.folder / "link.wav", csv = in.folder / "hard.csv", copy = in.folder / "folder";
  fs::create_symlink(in.run, link);
  fs::create_hard_link(in.run, csv);
  fs::create_directory(copy);
  fs::create_symlink(in.own, copy + "/corduroy.wpp");
  const std::string picture = in.folder / "linked.png", table = in.folder / "linked.csv";
  fs::create_symlink(in.own, picture);
  fs::create_symlink(in.own, table);
  // What a material reads is an input of whoever reads the material, also where it cannot be built.
  const std::string leaf = in.folder.write("leaf.png", bytes_of(std::string(WALE_SOURCE_DIR) + "/examples/learn/leaf.png"));
  const std::string relief = "wale 1\nmaterial leafy {\n  physical {\n    let leaf = relief(\"leaf.png\", scale: 0.5 mm/px, "
                             "height: 1 mm)\n    force = lateral(leaf";
  const std::string shown = in.folder.write("shown.wale", relief + "(hand), amplitude: 1 N)\n  }\n}\n"),
                    broken = in.folder.write("broken.wale", relief + ")\n  }\n}\n");
  std::string answers = "participant,stimulus,response,period\n";
  for (const char* person : {"a", "b", "c"})
    for (int i = 1; i <= 6; ++i)
      answers += std::string(person) + ",s" + std::to_string(i) + "," +
                 std::to_string(std::sqrt(i) * (1 + 0.01 * i * person[0] / 97)) + "," + std::to_string(i) + "\n";
  const std::string trials = in.folder.write("trials.csv", answers);
  const std::vector<Words> commands{
      {"build", in.own, "-o", in.own},
      {"build", in.own, "-o", picture},
      {"build", in.own, "--emit", "cpp", "-o", in.own},
      {"build", in.own, "--all", "-o", copy},
      {"preview", in.own, "-o", picture},
      {"sample", in.own, "--trace", in.trace, "-o", in.trace},
      {"sample", in.own, "--at", "0 mm, 0 mm", "-o", in.own},
      {"feel", in.own, "--virtual-time", "--seconds", "0.1", "--record", table},
      {"feel", in.own, "--hand", in.trace, "--virtual-time", "--seconds", "0.1", "--record", in.trace},
      {"library", "sheet", shown, "-o", leaf},
      {"library", "sheet", broken, "-o", leaf},
      {"library", "coverage", shown, "-o", leaf},
      {"calibrate", "report", trials, "--task", "magnitude_estimation", "--of", "roughness", "--carrier", "period",
       "--size", "period:mm", "--materials", shown, "-o", leaf},
      {"calibrate", "report", trials, "--task", "magnitude_estimation", "--of", "roughness", "--carrier", "period",
       "--size", "period:mm", "--materials", shown, "-o", shown},
      {"replay", in.run, "--csv", in.run},
      {"replay", in.run, "--csv", csv},
      {"replay", in.run, "--wav", link}};
  const auto before = in.bytes();
  for (const Words& words : commands) {
    expect_unwritten(wale(words), words, "W0508");
    EXPECT_EQ(in.bytes(), before) << testing::PrintToString(words);
  }
}

TEST(OutputFiles, ThatAreFoldersOrFullDevicesAreTold) {
  const Inputs in;
  for (const Writing& verb : writing()) {
    if (is_in_place(verb)) continue;  // what is no regular file is not read either: tests/command_line/inputs.cpp
    const std::string folder = in.folder / ("folder" + verb.suffix), full = in.folder / ("full" + verb.suffix);
    fs::create_directory(folder);
    fs::remove(full);
    fs::create_symlink("/dev/full", full);
    const Words into_folder = verb.words(in, folder), into_full = verb.words(in, full);
    expect_unwritten(wale(into_folder), into_folder, "W0505");
    EXPECT_TRUE(fs::is_empty(folder));
    expect_unwritten(wale(into_full), into_full, "W0505");
    EXPECT_TRUE(fs::is_symlink(full)) << "a device is written to, and not replaced";
    fs::remove(folder);
  }
}

TEST(OutputFiles, ThatArePipesAreWrittenAsTheyCome) {
  const Inputs in;
  for (const Writing& verb : writing()) {
    if (is_in_place(verb) || verb.suffix == ".wrec") continue;  // a recording is stored into, byte by byte
    const std::string file = in.folder / ("file" + verb.suffix), pipe = in.folder / ("pipe" + verb.suffix);
    fs::remove(pipe);
    ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
    ASSERT_EQ(wale(verb.words(in, file)).status, 0);
    const int reader = open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    fcntl(reader, F_SETPIPE_SZ, 1 << 20);
    const Outcome outcome = wale(verb.words(in, pipe));
    std::string bytes(1 << 20, '\0');
    const ssize_t got = read(reader, bytes.data(), bytes.size());
    close(reader);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(got, static_cast<ssize_t>(fs::file_size(file))) << testing::PrintToString(verb.words(in, pipe));
    bytes.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    EXPECT_EQ(bytes, bytes_of(file));
    fs::remove(file);
  }
}

}  // namespace
}  // namespace wale::command_line::outputs_test
