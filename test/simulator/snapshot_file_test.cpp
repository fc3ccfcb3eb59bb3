// SPDX-License-Identifier: BSD-3-Clause
//
// Files of snapshots: all of it is written or nothing, and only what may be a snapshot is read.
#include "curtain_sim/snapshot_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "curtain_sim/simulator.h"
#include "testing.h"

namespace curtain {
namespace {

namespace fs = std::filesystem;

std::string readText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

class SnapshotFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("snapshot_file_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    Simulator simulator(curtain_test::flatScene(4, 5));
    simulator.step();
    snapshot_ = simulator.snapshot();
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  // Names in the folder.
  std::size_t files() const { return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), {})); }
  void expectNotWritten(const std::string& to, const std::string& why) const {
    const std::vector<Problem> problems = writeSnapshotFile(to, snapshot_);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_NE(describe(problems).find(to), std::string::npos) << describe(problems);
    EXPECT_NE(describe(problems).find(why), std::string::npos) << describe(problems);
  }
  void expectNotRead(const std::string& from, const std::string& why) const {
    std::string out = "as it was";
    const std::vector<Problem> problems = readSnapshotFile(from, out);
    ASSERT_EQ(problems.size(), 1U);
    EXPECT_NE(describe(problems).find(why), std::string::npos) << describe(problems);
    EXPECT_EQ(out, "as it was");
  }

  fs::path folder_;
  std::string snapshot_;
};

TEST_F(SnapshotFile, IsReadAsItWasWritten) {
  for (int times = 0; times < 2; ++times) {
    EXPECT_TRUE(writeSnapshotFile(path("a.snap"), snapshot_).empty());
    std::string out;
    EXPECT_TRUE(readSnapshotFile(path("a.snap"), out).empty());
    EXPECT_TRUE(out == snapshot_);
    EXPECT_EQ(files(), 1U) << "nothing beside it";
  }
}

TEST_F(SnapshotFile, IsWrittenWhereALinkPoints) {
  ASSERT_TRUE(writeSnapshotFile(path("real.snap"), "older").empty());
  fs::create_symlink("real.snap", path("link.snap"));
  EXPECT_TRUE(writeSnapshotFile(path("link.snap"), snapshot_).empty());
  EXPECT_TRUE(fs::is_symlink(path("link.snap")));
  EXPECT_TRUE(readText(path("real.snap")) == snapshot_);
}

TEST_F(SnapshotFile, IsNotWrittenWhereItCanNotBe) {
  expectNotWritten(path("no folder/a.snap"), "No such file or directory");
  std::ofstream(path("file")) << "a file";
  expectNotWritten(path("file/a.snap"), "Not a directory");
  fs::create_directory(path("folder"));
  expectNotWritten(path("folder"), "not a file");
  expectNotWritten("/dev/null", "not a file");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  expectNotWritten("", "");
  EXPECT_EQ(files(), 2U);
  if (geteuid() == 0) return;  // whom nothing is forbidden
  fs::permissions(path("folder"), fs::perms::owner_read | fs::perms::owner_exec);
  expectNotWritten(path("folder/a.snap"), "Permission denied");
  fs::permissions(path("folder"), fs::perms::owner_all);
}

// As with a disk that is full: no file may grow beyond half a snapshot.
TEST_F(SnapshotFile, StaysAsItWasWhenThereIsNoRoom) {
  ASSERT_TRUE(writeSnapshotFile(path("a.snap"), "older").empty());
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = before;
  small.rlim_cur = snapshot_.size() / 2;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const std::vector<Problem> problems = writeSnapshotFile(path("a.snap"), snapshot_);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, handler);
  ASSERT_EQ(problems.size(), 1U);
  EXPECT_NE(describe(problems).find("File too large"), std::string::npos) << describe(problems);
  EXPECT_EQ(readText(path("a.snap")), "older");
  EXPECT_EQ(files(), 1U) << "the temporary file is gone";
}

// Killed in the middle of it: the system does that to who writes beyond the same limit and has not asked for an error
// instead.
TEST_F(SnapshotFile, LeavesNothingWhenItsWriterIsKilled) {
  ASSERT_TRUE(writeSnapshotFile(path("a.snap"), "older").empty());
  // Where the file system has no files without names what was begun is left, under a name of its own.
  const int descriptor = open(folder_.c_str(), O_WRONLY | O_TMPFILE, 0666);
  const std::size_t left_over = descriptor < 0 ? 1 : 0;
  if (descriptor >= 0) close(descriptor);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    const rlimit small{snapshot_.size() / 2, snapshot_.size() / 2};
    std::signal(SIGXFSZ, SIG_DFL);
    if (setrlimit(RLIMIT_FSIZE, &small) == 0) writeSnapshotFile(path("a.snap"), snapshot_);
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGXFSZ) << status;
  EXPECT_EQ(readText(path("a.snap")), "older");
  EXPECT_EQ(files(), 1U + left_over);
}

// Who reads meanwhile sees one snapshot or the other.
TEST_F(SnapshotFile, IsAlwaysWholeForWhoReads) {
  ASSERT_TRUE(writeSnapshotFile(path("a.snap"), snapshot_).empty());
  std::atomic<bool> done{false};
  std::thread writers[2];
  for (std::thread& writer : writers) {
    writer = std::thread([&] {
      for (int times = 0; times < 20; ++times) EXPECT_TRUE(writeSnapshotFile(path("a.snap"), snapshot_).empty());
    });
  }
  std::thread reader([&] {
    while (!done) {
      std::string out;
      EXPECT_TRUE(readSnapshotFile(path("a.snap"), out).empty());
      EXPECT_TRUE(out == snapshot_);
    }
  });
  for (std::thread& writer : writers) writer.join();
  done = true;
  reader.join();
  EXPECT_EQ(files(), 1U);
}

TEST_F(SnapshotFile, IsNotReadWhereThereIsNone) {
  expectNotRead(path("none"), "No such file or directory");
  expectNotRead(path(""), "not a file");
  expectNotRead("/dev/zero", "not a file");
  ASSERT_EQ(mkfifo(path("pipe").c_str(), 0600), 0);
  expectNotRead(path("pipe"), "not a file");  // at once, though nobody writes to it
  std::ofstream(path("empty"));
  expectNotRead(path("empty"), "is no snapshot");
  std::ofstream(path("scene.yaml")) << "cloth: {rows: 4, columns: 5}\n";
  expectNotRead(path("scene.yaml"), "is no snapshot");
  std::ofstream(path("short"), std::ios::binary) << snapshot_.substr(0, 100);
  expectNotRead(path("short"), "is cut short: 100 bytes");
  std::ofstream(path("shorter"), std::ios::binary) << snapshot_.substr(0, 20);
  expectNotRead(path("shorter"), "is cut short");
}

// A hundred gigabytes of nothing, foreign or with a header that is true to them: neither is read.
TEST_F(SnapshotFile, IsNotReadWhenItIsHuge) {
  constexpr std::uint64_t kHuge = 100ULL << 30;
  for (const bool foreign : {true, false}) {
    std::string begin = foreign ? std::string("something else") : snapshot_.substr(0, 48);
    if (!foreign) begin.replace(32, 8, reinterpret_cast<const char*>(&kHuge), 8);
    std::ofstream(path("huge"), std::ios::binary) << begin;
    std::error_code error;
    fs::resize_file(path("huge"), kHuge, error);
    if (error) GTEST_SKIP() << "no room for a file with a hole: " << error.message();
    expectNotRead(path("huge"), foreign ? "is no snapshot" : "is too large");
  }
}

}  // namespace
}  // namespace curtain
