// sweep where Slurm is not there, refuses, or is a script that says what it was asked.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/read_text.h"
#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class SweepCommand : public ::testing::Test {
protected:
    void SetUp() override {
        const char* const before = std::getenv("PATH");
        path_before_ = before ? before : "";
        ::setenv("PATH", path("bin").c_str(), 1);
        fs::create_directory(path("bin"));
        command("sinfo", "echo 'main* n1'; echo 'main* n2'; echo 'big n2'; echo 'big n3'; echo 'big n4'");
        command("squeue", "cat " + path("queue") + " 2>&1 || :");
        command("sbatch", "echo \"$*\" >>" + path("asked") + "; echo '7;cluster'");
        std::ofstream(path("queue"));
    }
    void TearDown() override { ::setenv("PATH", path_before_.c_str(), 1); }

    std::string path(const std::string& name) const { return temporary_.path(name); }
    void command(const std::string& name, const std::string& text) const {
        const std::string file = path("bin/" + name);
        std::ofstream(file) << "#!/bin/sh\nPATH=/usr/bin:/bin\n" << text << "\n";
        fs::permissions(file, fs::perms::owner_all);
    }
    Outcome sweep(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"sweep", SHADOWBENCH_SOURCE_DIR "/scenarios/sweeps/quickstart_sweep.json",
                                           "--out", path("sweep")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return cli(arguments);
    }

    const TemporaryFolder temporary_;
    std::string path_before_;
};

TEST_F(SweepCommand, SubmitsAnArrayAndAMergeThatNeverWaitsForEver) {
    const Outcome outcome = sweep({"--partition", "big", "--only", "deep"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("submitted: job 7, 3 parts of "));
    const std::string asked = base::read_text(path("asked"));
    const std::string array = asked.substr(0, asked.find('\n')), merge = asked.substr(array.size() + 1);
    for (const char* word : {"--array=0-2 ", "--exclusive ", "--requeue ", "--partition=big ", "--only deep ",
                             "--shard $SLURM_ARRAY_TASK_ID/3 "})
        EXPECT_THAT(array, HasSubstr(word));
    EXPECT_THAT(merge, HasSubstr("--dependency=afterany:7 ")) << "afterok would wait behind a part that failed";
    EXPECT_THAT(merge, HasSubstr(" merge " + path("sweep") + " --out " + path("sweep/result") + ";"));
    EXPECT_TRUE(fs::exists(path("sweep/sweep.json")));
}

TEST_F(SweepCommand, AsksForNoMorePartsThanThereAreCells) {
    const Outcome outcome = sweep({"--print", "--nodes", "100000"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, Not(HasSubstr("--array=0-99999")));
    EXPECT_THAT(outcome.out, HasSubstr("--dependency=afterany:\"${parts%%;*}\""));
    EXPECT_FALSE(fs::exists(path("sweep"))) << "--print writes nothing";
    EXPECT_FALSE(fs::exists(path("asked")));
    EXPECT_THAT(sweep({"--print"}).out, HasSubstr("--array=0-1 ")) << "the nodes of the default partition";
}

// Else the same command again would measure everything twice.
TEST_F(SweepCommand, DoesNotSubmitWhatIsInTheQueue) {
    std::ofstream(path("queue")) << "sweep-0 RUNNING None\nsweep-0 PENDING Resources\n";
    const Outcome outcome = sweep();
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("in the queue since an earlier call: 1 running, 1 waiting (Resources); 0 of "));
    EXPECT_FALSE(fs::exists(path("asked")));
}

// An array without its merge would end without a result.
TEST_F(SweepCommand, TakesTheArrayBackIfTheMergeIsRefused) {
    command("sbatch", "case \"$*\" in *afterany*) echo 'sbatch: error: QOSMaxSubmitJob' >&2; exit 1;; esac; echo 12");
    command("scancel", "echo \"$*\" >" + path("cancelled"));
    const Outcome outcome = sweep();
    EXPECT_EQ(outcome.code, 74);
    EXPECT_THAT(outcome.err, HasSubstr("sbatch: sbatch: error: QOSMaxSubmitJob; sinfo"));
    EXPECT_EQ(base::read_text(path("cancelled")), "12\n");
}

TEST_F(SweepCommand, ErrorsNameTheRemedy) {
    const Outcome partition = sweep({"--partition", "huge"});
    EXPECT_EQ(partition.code, 64);
    EXPECT_THAT(partition.err, HasSubstr("--partition huge: Slurm has no such partition"));
    EXPECT_THAT(partition.err, HasSubstr("there are: big, main"));
    command("sinfo", "echo 'big n2'");
    EXPECT_THAT(sweep().err, HasSubstr("no default partition; name one with --partition; there are: big"));
    command("sinfo", "echo 'slurm_load_partitions: Unable to contact slurm controller' >&2; exit 1");
    EXPECT_THAT(sweep().err, HasSubstr("Unable to contact slurm controller; sinfo and scontrol ping"));
    fs::remove(path("bin/sinfo"));
    const Outcome missing = sweep();
    EXPECT_EQ(missing.code, 66);
    EXPECT_THAT(missing.err, HasSubstr("sinfo: the program is not in $PATH; run this where Slurm's commands are"));
    EXPECT_THAT(missing.err, HasSubstr("--engine parallel"));
    const Outcome parallel = sweep({"--engine", "parallel"});
    EXPECT_EQ(parallel.code, 66);
    EXPECT_THAT(parallel.err, HasSubstr("install GNU parallel"));
    EXPECT_EQ(sweep({"--ssh", "n1"}).code, 64);
    EXPECT_EQ(sweep({"--engine", "parallel", "--partition", "main"}).code, 64);
    EXPECT_EQ(sweep({"--engine", "make"}).code, 64);
}

// The merge that Slurm's controller forgot.
TEST_F(SweepCommand, WaitingMergesHereIfSlurmDidNot) {
    command("squeue", "echo x >>" + path("looks") + "; [ $(wc -l <" + path("looks") + ") -lt 2 ] || [ $(wc -l <" +
                          path("looks") + ") -gt 3 ] || echo 'merge-0 PENDING Dependency'");
    const Outcome outcome = sweep({"--wait"});
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("Slurm did not merge the parts; merged here.\n"));
    EXPECT_THAT(outcome.out, HasSubstr("cells are missing"));
}

}  // namespace
}  // namespace shadowbench::service
