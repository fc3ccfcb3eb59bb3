// SPDX-License-Identifier: BSD-3-Clause
//
// --checkpoint and --every: a run that is killed and started again, as often as it may be, ends with the bits and the
// files of the run that nobody stops. What is no checkpoint of this run is refused, and nothing is written. A disk that
// is full ends the run with exit code 4, and the last checkpoint stays.
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <random>
#include <thread>

#include "batch/batch_testing.h"

namespace {

using curtain_test::BatchTest;
using curtain_test::kMoving;
using curtain_test::Outcome;
using curtain_test::readFile;

class Checkpoints : public BatchTest {
 protected:
  void SetUp() override {
    BatchTest::SetUp();
    scene_ = smallScene(kMoving);
    const Outcome whole = batch(outputs("whole"));
    ASSERT_EQ(whole.exit_code, 0) << whole.err;
  }

  // A run of 180 frames with all its outputs.
  std::vector<std::string> outputs(const std::string& name) const {
    std::string times = "0,1";  // most are late: the first checkpoints come before them
    for (int tenth = 1; tenth < 100; tenth += 2)
      times += ",2." + std::string(tenth < 10 ? "0" : "") + std::to_string(tenth);
    return {scene_,   "--duration",  "3",       "--out",        name + ".csv", "--sample",     times + ",2.995",
            "--mesh", name + ".ply", "--stats", name + ".json", "--wrenches",  name + ".w.csv"};
  }
  std::vector<std::string> kept(const std::string& name, const std::string& every = "0.1") const {
    std::vector<std::string> arguments = outputs(name);
    arguments.insert(arguments.end(), {"--checkpoint", name + ".ck", "--every", every});
    return arguments;
  }

  // Kills the program after a while; true: it was done before.
  bool killedAfter(std::vector<std::string> arguments, std::chrono::microseconds delay) const {
    arguments.insert(arguments.begin(), CURTAIN_BATCH);
    std::vector<char*> argv;
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
      if (chdir(folder_.c_str()) == 0 && freopen("/dev/null", "w", stderr) != nullptr)
        execv(CURTAIN_BATCH, argv.data());
      _exit(127);
    }
    std::this_thread::sleep_for(delay);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status);
  }

  void expectWhole(const std::string& name) const {
    EXPECT_EQ(readFile(path(name + ".csv")), readFile(path("whole.csv")));
    EXPECT_EQ(readFile(path(name + ".w.csv")), readFile(path("whole.w.csv")));
    EXPECT_EQ(readFile(path(name + ".ply")), readFile(path("whole.ply")));
    auto whole = nlohmann::json::parse(readFile(path("whole.json")));
    auto own = nlohmann::json::parse(readFile(path(name + ".json")));
    EXPECT_GT(own.at("ms_per_frame").at("max").get<double>(), 0.0);
    for (const char* timed : {"wall_s", "ms_per_frame", "stages"}) {
      whole.erase(timed);
      own.erase(timed);
    }
    EXPECT_EQ(own, whole);
  }

  void expectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& fragments) const {
    std::map<std::string, std::string> before;
    for (const std::string& file : files()) before[file] = readFile(path(file));
    const Outcome run = batch(arguments);
    EXPECT_EQ(run.exit_code, 2) << run.err;
    EXPECT_EQ(curtain_test::lines(run.err).size(), 1U) << run.err;
    EXPECT_EQ(run.err.rfind("curtain_batch: ", 0), 0U) << run.err;
    for (const std::string& fragment : fragments) EXPECT_NE(run.err.find(fragment), std::string::npos) << run.err;
    std::map<std::string, std::string> after;
    for (const std::string& file : files()) after[file] = readFile(path(file));
    EXPECT_TRUE(after == before) << "nothing is written";
  }

  std::string scene_;
};

TEST_F(Checkpoints, ChangeNothing) {
  const Outcome run = batch(kept("kept"));
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(run.err, "");
  expectWhole("kept");
}

TEST_F(Checkpoints, OfARunKilledAtRandomMomentsGoOnToTheSameBits) {
  std::mt19937 random(20);
  std::uniform_int_distribution<int> delay(2000, 30000);  // us
  int kills = 0;
  for (int run = 0; run < 3; ++run) {
    const std::string name = "killed" + std::to_string(run);
    int tries = 0;
    while (!killedAfter(kept(name), std::chrono::microseconds(delay(random)) * (1 + tries / 20))) ++tries;
    kills += tries;
    expectWhole(name);
    for (const std::string& file : files()) EXPECT_EQ(file.find(".tmp-"), std::string::npos) << "left over: " << file;
  }
  EXPECT_GE(kills, 6);
}

TEST_F(Checkpoints, OfADoneRunWriteItsEndAgainAndMakeNoFrame) {
  ASSERT_EQ(batch(kept("kept")).exit_code, 0);
  const std::string stats = readFile(path("kept.json"));
  std::filesystem::remove(path("kept.ply"));
  std::ofstream(path("kept.csv"), std::ios::app) << "what a run wrote that the checkpoint knows nothing of";
  const Outcome again = batch(kept("kept"));
  EXPECT_EQ(again.exit_code, 0);
  EXPECT_NE(again.err.find("kept.ck: was done at t = 3 s"), std::string::npos) << again.err;
  EXPECT_EQ(readFile(path("kept.json")), stats) << "computing times, too: no frame was made";
  expectWhole("kept");
}

TEST_F(Checkpoints, OfARestoredRunAreItsOwn) {
  const std::vector<std::string> half = {scene_, "--duration", "0.5", "--save", "half.snap"};
  ASSERT_EQ(batch(half).exit_code, 0);
  const std::vector<std::string> rest = {scene_,  "--restore", "half.snap",    "--duration", "0.5",
                                         "--out", "rest.csv",  "--checkpoint", "rest.ck"};
  ASSERT_EQ(batch(rest).exit_code, 0);
  ASSERT_EQ(batch({scene_, "--duration", "1", "--out", "one.csv"}).exit_code, 0);
  EXPECT_EQ(readFile(path("rest.csv")), readFile(path("one.csv")));
  ASSERT_EQ(batch({scene_, "--duration", "0.4", "--save", "half.snap"}).exit_code, 0);
  expectRefused(rest, {"rest.ck", "--restore", "another run"});
}

TEST_F(Checkpoints, TakeAwayWhatAKilledRunHasLeftAndNothingElse) {
  for (const char* half : {"kept.ck.tmp-123-0", "kept.ply.tmp-123-6", "kept.json.tmp-123-7"})
    std::ofstream(path(half)) << "half";
  std::ofstream(path("kept.ck.tmp-notes")) << "somebody's";
  std::filesystem::create_directories(path("kept.ck.tmp-1-2/full"));
  const Outcome run = batch(kept("kept"));
  EXPECT_EQ(run.exit_code, 0) << run.err;
  for (const char* half : {"kept.ck.tmp-123-0", "kept.ply.tmp-123-6", "kept.json.tmp-123-7"})
    EXPECT_FALSE(std::filesystem::exists(path(half))) << half;
  EXPECT_TRUE(std::filesystem::exists(path("kept.ck.tmp-notes")));
  EXPECT_TRUE(std::filesystem::exists(path("kept.ck.tmp-1-2/full")));
}

TEST_F(Checkpoints, OfAnotherRunAreRefused) {
  ASSERT_EQ(batch(kept("kept")).exit_code, 0);
  const auto with = [&](const std::string& option, const std::string& value) {
    std::vector<std::string> arguments = kept("kept");
    for (std::size_t k = 0; k + 1 < arguments.size(); ++k) {
      if (arguments[k] == option) arguments[k + 1] = value;
    }
    return arguments;
  };
  expectRefused(with("--duration", "11"), {"kept.ck", "--duration", "'11'", "'3'", "another run"});
  expectRefused(with("--sample", "0,3"), {"--sample", "'0,3'", "another run"});
  expectRefused(with("--out", "new.csv"), {"--out", "new.csv", "kept.csv"});
  expectRefused(with("--mesh", "new.ply"), {"--mesh", "new.ply"});
  EXPECT_EQ(batch(with("--every", "2")).exit_code, 0) << "how often is not of the run";
  // Also what a snapshot lets change.
  smallScene(std::string(kMoving) + "gravity: [0, 0, -1.6]\n");
  expectRefused(kept("kept"), {"kept.ck", "gravity", "another run"});
  smallScene();
  expectRefused(kept("kept"), {"kept.ck", "another run"});
}

TEST_F(Checkpoints, ThatAreDamagedOrNoneAreRefused) {
  ASSERT_EQ(batch(kept("kept")).exit_code, 0);
  const std::string good = readFile(path("kept.ck"));
  const auto put = [&](const std::string& bytes) { std::ofstream(path("kept.ck"), std::ios::binary) << bytes; };
  const std::size_t step = good.size() / 10;
  for (std::size_t at = 0; at < good.size(); at += step) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    put(bad);
    expectRefused(kept("kept"), {"kept.ck"});
    put(good.substr(0, at));
    expectRefused(kept("kept"), {"kept.ck"});
  }
  put(good + "x");
  expectRefused(kept("kept"), {"kept.ck", "too long"});
  std::filesystem::remove(path("kept.ck"));
  std::filesystem::create_directories(path("kept.ck"));
  expectRefused(kept("kept"), {"kept.ck", "folder"});
  std::filesystem::remove(path("kept.ck"));
  put(good);
  std::ofstream(path("kept.csv")) << "t,row,column,x,y,z,vx,vy,vz\nsomebody else's\n";
  expectRefused(kept("kept"), {"kept.csv", "not the file"});
  std::filesystem::remove(path("kept.csv"));
  expectRefused(kept("kept"), {"kept.csv", "not the file"});
}

TEST_F(Checkpoints, OptionsThatDoNotGoTogetherAreRefused) {
  expectRefused({scene_, "--every", "1"}, {"--every", "--checkpoint"});
  expectRefused({scene_, "--checkpoint", "a.ck", "--every", "0"}, {"--every", "> 0"});
  expectRefused({scene_, "--checkpoint", "a.ck", "--every", "-1"}, {"--every", "'-1'"});
  expectRefused({scene_, "--checkpoint", "no folder/a.ck"}, {"--checkpoint", "no folder"});
  expectRefused({scene_, "--checkpoint", "a.ck", "--save", "./a.ck"}, {"--save", "a.ck", "checkpoint, too"});
}

// A limit of file sizes in place of the disk's, which tests can set: the write fails in the same place.
TEST_F(Checkpoints, StayWhenTheDiskIsFull) {
  while (!std::filesystem::exists(path("kept.ck"))) killedAfter(kept("kept"), std::chrono::milliseconds(20));
  const std::string good = readFile(path("kept.ck"));
  const auto limited = [&](rlim_t bytes) {
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const rlimit limit{bytes, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    const Outcome run = batch(kept("kept"));
    setrlimit(RLIMIT_FSIZE, &before);
    return run;
  };
  // The next checkpoint does not fit.
  const Outcome no_checkpoint = limited(good.size() / 2);
  EXPECT_EQ(no_checkpoint.exit_code, 4) << no_checkpoint.err;
  EXPECT_NE(no_checkpoint.err.find("--checkpoint: kept.ck: cannot be written: File too large"), std::string::npos)
      << no_checkpoint.err;
  EXPECT_EQ(readFile(path("kept.ck")), good);
  // The checkpoints fit, --out does not.
  const std::size_t whole = readFile(path("whole.csv")).size();
  ASSERT_GT(whole, 2 * good.size()) << "else the limit below is one of checkpoints";
  const Outcome no_sample = limited(whole - 10);
  EXPECT_EQ(no_sample.exit_code, 4);
  EXPECT_NE(no_sample.err.find("kept.csv: cannot be written: File too large"), std::string::npos) << no_sample.err;
  const Outcome enough = batch(kept("kept"));
  EXPECT_EQ(enough.exit_code, 0) << enough.err;
  expectWhole("kept");
}

}  // namespace
