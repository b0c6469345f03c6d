// `serve` and `submit`, as a user runs them.
#include "service/cli/server_commands.h"
#include "service/cli/token_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "processes.h"
#include "service/http/client.h"
#include "service/run_cli.h"
#include "service/tiny_scenario.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class ServerCommands : public testing::Test {
protected:
    void SetUp() override { write("tiny.json", tiny); }
    void TearDown() override { stop(); }

    std::string write(const std::string& name, const std::string& text) const {
        std::ofstream(folder_ / name) << text;
        return path(name);
    }
    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    // The program itself, as a process, until it has written its port.
    void serve(std::vector<std::string> more = {}) {
        std::vector<std::string> words{program_,  "serve",       "--port",  port_, "--port-file", path("port"),
                                       "--state", path("state"), "--grace", "0",   "--log-level", "warning"};
        words.insert(words.end(), more.begin(), more.end());
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        argv.push_back(nullptr);
        fs::remove(path("port"));
        server_ = ::fork();
        if (server_ == 0) {
            ::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), 1);
            ::execv(argv[0], argv.data());
            ::_exit(127);
        }
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
        while (!fs::exists(path("port")) && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        std::string port = read(path("port"));
        ASSERT_FALSE(port.empty());
        port.pop_back();
        url_ = "http://127.0.0.1:" + port;
    }

    // The exit status after SIGTERM.
    int stop() {
        if (server_ <= 0) return -1;
        int status = 0;
        ::kill(server_, SIGTERM);
        ::waitpid(server_, &status, 0);
        server_ = 0;
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

    const TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
    std::string program_ = SHADOWBENCH_PROGRAM, port_ = "0";
    pid_t server_ = 0;
    std::string url_;
};

// The table of `run`, but for what the clock says: its lines of words.
std::string words_of(const std::string& table) {
    std::string words;
    std::istringstream lines(table);
    bool capture = false;  // whose lines go on
    for (std::string line; std::getline(lines, line) && line.rfind("light ", 0) != 0;) {
        capture = line.rfind("    capture:", 0) == 0 || (capture && line.rfind("    truth:", 0) != 0);
        const bool row =
            line.rfind("  technique", 0) == 0 || line.rfind("  deep", 0) == 0 || line.rfind("  uncomp", 0) == 0;
        if (!capture && !row) words += line + "\n";
    }
    return words;
}

TEST_F(ServerCommands, SubmitPrintsTheTableThatRunPrints) {
    serve();
    const Outcome submitted = cli({"submit", path("tiny.json"), "--server", url_, "--wait", "--no-pictures"});
    EXPECT_EQ(submitted.code, 0) << submitted.err;
    const Outcome run = cli({"run", path("tiny.json"), "--out", path("run")});
    EXPECT_EQ(words_of(submitted.out), words_of(run.out));
    EXPECT_NE(submitted.out.find("  uncompressed "), std::string::npos) << submitted.out;
    EXPECT_NE(submitted.out.find("result: " + url_ + "/v1/jobs/j-"), std::string::npos) << submitted.out;
    EXPECT_EQ(stop(), 0);
}

TEST_F(ServerCommands, JobsStartThroughTheLauncher) {
    const std::string launcher = write("launcher", "#!/bin/sh\necho \"$*\" >" + path("asked") + "\nexec \"$@\"\n");
    fs::permissions(launcher, fs::perms::owner_all);
    serve({"--launcher", launcher});
    const Outcome submitted = cli({"submit", path("tiny.json"), "--server", url_, "--wait", "--no-pictures"});
    EXPECT_EQ(submitted.code, 0) << submitted.err;
    EXPECT_EQ(read(path("asked")).rfind(fs::canonical(SHADOWBENCH_PROGRAM).string() + " guard --seconds 3600 ", 0), 0u)
        << "no file that only this machine sees: " << read(path("asked"));
}

// With its own library for images, since that of another build would not fit.
TEST_F(ServerCommands, JobsAndHelpersAreRunByTheProgramThatServes) {
    program_ = path("program");
    const fs::path images = folder_ / fs::path(SHADOWBENCH_IMAGES).filename();
    fs::copy_file(SHADOWBENCH_PROGRAM, program_);
    fs::copy_file(SHADOWBENCH_IMAGES, images);
    serve();
    const std::string next = write("next", "#!/bin/sh\nexit 70\n");
    fs::permissions(next, fs::perms::owner_all);
    fs::rename(next, program_);
    fs::rename(write("next.so", "no library"), images);
    const std::vector<std::string> submit{"submit", path("tiny.json"), "--server", url_, "--wait", "--fresh"};
    const Outcome replaced = cli(submit);
    EXPECT_EQ(replaced.code, 0) << replaced.err;
    fs::remove(program_);
    fs::remove(images);
    const Outcome removed = cli(submit);
    EXPECT_EQ(removed.code, 0) << removed.err;
}

// Clients do not learn where the server is installed.
TEST_F(ServerCommands, WithoutTheLibraryForImagesAJobNamesItWithoutItsFolder) {
    program_ = path("program");
    fs::copy_file(SHADOWBENCH_PROGRAM, program_);
    serve();
    const Outcome failed = cli({"submit", path("tiny.json"), "--server", url_, "--wait"});
    EXPECT_NE(failed.code, 0);
    const std::string name = fs::path(SHADOWBENCH_IMAGES).filename().string();
    EXPECT_THAT(failed.err, ::testing::HasSubstr(name));
    EXPECT_THAT(failed.err, ::testing::Not(::testing::HasSubstr("/" + name)));
}

TEST_F(ServerCommands, TechniquesFromOutsideComeFromItsFolderAndMayCrash) {
    fs::create_directory(path("libraries"));
    fs::copy_file(SHADOWBENCH_FAULTY, path("libraries/libfaulty.so"));
    write("libraries/notes.txt", "no library");
    nlohmann::json scenario = nlohmann::json::parse(tiny);
    scenario["techniques"] = {{{"type", "deep"}}, {{"type", "faulty"}, {"fault", "crash"}}};
    write("crash.json", scenario.dump());
    serve({"--technique-libraries", path("libraries")});
    const Outcome crash = cli({"submit", path("crash.json"), "--server", url_, "--wait", "--no-pictures"});
    EXPECT_EQ(crash.code, 2) << crash.err;
    EXPECT_THAT(crash.out, ::testing::ContainsRegex("lookup\\(\\) ended its[ \n]+process by signal 11"));
    EXPECT_THAT(crash.out, ::testing::HasSubstr("\n  deep "));
}

// Every check of a scenario has a process of its own, which would wait for the library for longer than a check may
// take.
TEST_F(ServerCommands, ALibraryThatHangsWhenItIsOpenedCostsOnlyItsRow) {
    fs::create_directory(path("libraries"));
    fs::copy_file(SHADOWBENCH_FAULTY, path("libraries/libfaulty.so"));
    nlohmann::json scenario = nlohmann::json::parse(tiny);
    scenario["techniques"] = {{{"type", "deep"}}, {{"type", "faulty"}}};
    write("hang.json", scenario.dump());
    ::setenv("SHADOWBENCH_TEST_FAULT", "hang", 1);
    ::setenv("SHADOWBENCH_TEST_OPENED", path("opened").c_str(), 1);
    serve({"--technique-libraries", path("libraries"), "--call-seconds", "0.3"});
    ::unsetenv("SHADOWBENCH_TEST_FAULT");
    ::unsetenv("SHADOWBENCH_TEST_OPENED");
    const Outcome hang = cli({"submit", path("hang.json"), "--server", url_, "--wait", "--no-pictures"});
    EXPECT_EQ(hang.code, 2) << hang.err;
    EXPECT_THAT(hang.out, ::testing::ContainsRegex("did[ \n]+not[ \n]+answer[ \n]+within[ \n]+0.3[ \n]+s"));
    EXPECT_THAT(hang.out, ::testing::HasSubstr("\n  deep "));
    EXPECT_EQ(read(path("opened")), "opened\n") << "once, when the server started";
}

TEST_F(ServerCommands, SubmitWaitsForAServerThatIsStartedAnew) {
    serve();
    // Long enough to be cut off.
    const std::string command = std::string(SHADOWBENCH_PROGRAM) + " submit " + path("tiny.json") + " --server " +
                                url_ +
                                " --wait --no-pictures --set timing.repetitions=200 --set timing.lookups=100000 >" +
                                path("out") + " 2>" + path("err");
    int code = -1;
    std::thread waiting([&] { code = std::system(command.c_str()); });
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    const auto wait_until = [&](const auto& condition) {
        while (!condition() && std::chrono::steady_clock::now() < end)
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
    };
    Client client(url_, "");
    wait_until([&] { return client.get("/v1/jobs").body.find("\"running\"") != std::string::npos; });
    EXPECT_EQ(stop(), 0);
    wait_until([&] { return read(path("err")).find("trying again for 60 s") != std::string::npos; });
    port_ = url_.substr(url_.rfind(':') + 1);
    serve();
    waiting.join();
    EXPECT_EQ(code, 0) << read(path("err"));
    EXPECT_NE(read(path("err")).find("trying again for 60 s"), std::string::npos);
    EXPECT_NE(read(path("out")).find("  uncompressed "), std::string::npos);
}

// Not even its first word needs a server yet, and is heard once.
TEST_F(ServerCommands, SubmitWaitsForAServerThatIsNotThereYet) {
    serve();
    EXPECT_EQ(stop(), 0);
    Outcome submitted;
    std::thread waiting([&, server = url_] {
        submitted = cli({"submit", path("tiny.json"), "--server", server, "--wait", "--no-pictures"});
    });
    std::this_thread::sleep_for(std::chrono::seconds(1));
    port_ = url_.substr(url_.rfind(':') + 1);
    serve();
    waiting.join();
    EXPECT_EQ(submitted.code, 0) << submitted.err;
    EXPECT_NE(submitted.err.find("trying again for 60 s"), std::string::npos) << submitted.err;
    const auto jobs = nlohmann::json::parse(Client(url_, "").get("/v1/jobs").body);
    EXPECT_EQ(jobs.at("jobs").size(), 1u);
}

TEST_F(ServerCommands, SubmitPrintsTheJobAndDoesNotWait) {
    serve();
    const Outcome submitted = cli({"submit", path("tiny.json"), "--server", url_ + "/", "--set", "rays.seed=9"});
    EXPECT_EQ(submitted.code, 0) << submitted.err;
    EXPECT_TRUE(submitted.out.starts_with("j-")) << submitted.out;
}

TEST_F(ServerCommands, SubmitAsksForARecommendation) {
    serve();
    const Outcome submitted = cli({"submit", path("tiny.json"), "--server", url_, "--recommend", "0.25",
                                   "--budget", "2min", "--fresh"});
    EXPECT_EQ(submitted.code, 0) << submitted.err;
    const std::string id = submitted.out.substr(0, submitted.out.find(' '));
    const auto job = nlohmann::json::parse(Client(url_, "").get("/v1/jobs/" + id).body);
    EXPECT_EQ(job["kind"], "recommendation");
    EXPECT_EQ(job["recommend"]["error"], 0.25);
    EXPECT_EQ(job["recommend"]["budget"], 120.0);
    EXPECT_EQ(cli({"submit", path("tiny.json"), "--server", url_, "--recommend", "5"}).code, 64);
}

TEST_F(ServerCommands, SubmitFailsAsRunDoes) {
    serve();
    const Outcome wrong = cli({"submit", path("tiny.json"), "--server", url_, "--set", "rays.resolution=large"});
    EXPECT_EQ(wrong.code, 65);
    EXPECT_NE(wrong.err.find("/rays/resolution"), std::string::npos) << wrong.err;
    EXPECT_EQ(cli({"submit", path("none.json"), "--server", url_}).code, 66);
    EXPECT_EQ(cli({"submit", path("tiny.json"), "--server", "localhost"}).code, 64);
    EXPECT_EQ(stop(), 0);
    EXPECT_EQ(cli({"submit", path("tiny.json"), "--server", url_}).code, 74) << "nobody is there";
}

TEST_F(ServerCommands, ATokenIsAskedForAndGiven) {
    const std::string token = write("token", "0123456789abcdef\n");
    fs::permissions(token, fs::perms::owner_read | fs::perms::owner_write);
    serve({"--token-file", token, "--host", "0.0.0.0"});
    EXPECT_EQ(cli({"submit", path("tiny.json"), "--server", url_}).code, 64);
    EXPECT_EQ(cli({"submit", path("tiny.json"), "--server", url_, "--token-file", token}).code, 0);
}

TEST_F(ServerCommands, TokensAreOneLongWordForOneReader) {
    const auto code_of = [&](const std::string& text, fs::perms perms) {
        const std::string file = write("token", text);
        fs::permissions(file, perms);
        try {
            read_token(file);
        } catch (const base::Error& error) {
            return static_cast<int>(error.code());
        }
        return 0;
    };
    const fs::perms mine = fs::perms::owner_read | fs::perms::owner_write;
    EXPECT_EQ(code_of("# of the lab\n\n0123456789abcdef\n", mine), 0);
    EXPECT_EQ(code_of("0123456789abcde\n", mine), 65);
    EXPECT_EQ(code_of("\xef\xbb\xbf"
                      "0123456789abcde\n",
                      mine),
              65)
        << "a byte-order mark is not part of the token";
    EXPECT_EQ(code_of("0123456789 abcdef\n", mine), 65);
    EXPECT_EQ(code_of("", mine), 65);
    EXPECT_EQ(code_of("0123456789abcdef\n", mine | fs::perms::group_read), 65);
    EXPECT_EQ(code_of("0123456789abcdef\n", mine | fs::perms::others_read), 65);
    EXPECT_THROW(read_token(path("missing")), base::Error);
}

TEST_F(ServerCommands, ServeRefusesWhatItCannotDo) {
    EXPECT_EQ(cli({"serve", "--host", "0.0.0.0", "--port", "0", "--state", path("state")}).code, 64);
    EXPECT_EQ(cli({"serve", "--data", path("none"), "--port", "0", "--state", path("state")}).code, 66);
    EXPECT_EQ(cli({"serve", "--port", "70000"}).code, 64);
    EXPECT_EQ(cli({"serve", "--token-file", path("none"), "--state", path("state")}).code, 66);
    EXPECT_EQ(cli({"serve", "--launcher", "no-such-launcher -N1", "--state", path("state")}).code, 66);
    const Outcome assigned = cli({"serve", "--launcher", "A=1 srun", "--state", path("state")});
    EXPECT_EQ(assigned.code, 64) << "every job would fail";
    EXPECT_NE(assigned.err.find("begin with a command, as in 'env A=1 srun'"), std::string::npos) << assigned.err;
}

TEST_F(ServerCommands, ServeLeavesTheFoldersOfOthersAlone) {
    fs::create_directories(folder_ / "mine" / "jobs");
    fs::create_directories(folder_ / "mine" / "work");
    write("mine/work/a", "a\n");
    const Outcome refused = cli({"serve", "--port", "0", "--state", path("mine")});
    EXPECT_EQ(refused.code, 64);
    EXPECT_NE(refused.err.find(path("mine")), std::string::npos) << refused.err;
    EXPECT_NE(refused.err.find("--state"), std::string::npos) << refused.err;
    EXPECT_EQ(read(folder_ / "mine" / "work" / "a"), "a\n");
    std::size_t entries = 0;
    for ([[maybe_unused]] const auto& entry : fs::recursive_directory_iterator(folder_ / "mine")) ++entries;
    EXPECT_EQ(entries, 3u);
}

TEST_F(ServerCommands, ServeSaysWhatItMovedAway) {
    serve();
    EXPECT_EQ(stop(), 0);
    write("state/work/a", "a\n");
    const std::string command = std::string(SHADOWBENCH_PROGRAM) + " serve --port 0 --port-file " + path("again") +
                                " --state " + path("state") + " >" + path("out") + " 2>" + path("err") +
                                " & echo $! >" + path("number");
    ASSERT_EQ(std::system(command.c_str()), 0);
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
    while (!fs::exists(path("again")) && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ::kill(std::stoi(read(path("number"))), SIGTERM);
    const std::string said = read(path("err"));
    EXPECT_NE(said.find(" warning recovery " + path("state/work/a") + ": "), std::string::npos) << said;
    EXPECT_NE(said.find(path("state/lost+found/")), std::string::npos) << said;
}

// The children of a process, and theirs; threads have children of their own.
std::vector<pid_t> descendants(pid_t process) {
    std::vector<pid_t> all;
    std::error_code ended;
    for (const auto& task : fs::directory_iterator("/proc/" + std::to_string(process) + "/task", ended)) {
        std::ifstream children(task.path() / "children");
        for (pid_t child = 0; children >> child;) {
            all.push_back(child);
            for (const pid_t grandchild : descendants(child)) all.push_back(grandchild);
        }
    }
    return all;
}

TEST_F(ServerCommands, AServerThatIsKilledTakesItsProcessesAlong) {
    serve();
    const Outcome submitted = cli({"submit", path("tiny.json"), "--server", url_, "--no-pictures", "--set",
                                   "timing.repetitions=200", "--set", "timing.lookups=1000000"});
    ASSERT_EQ(submitted.code, 0) << submitted.err;
    Client client(url_, "");
    EXPECT_TRUE(soon([&] { return client.get("/v1/jobs").body.find("\"stage\"") != std::string::npos; }));
    const std::vector<pid_t> children = descendants(server_);
    EXPECT_GE(children.size(), 2u) << "a job and its keeper";
    ::kill(server_, SIGKILL);
    ::waitpid(server_, nullptr, 0);
    server_ = 0;
    for (const pid_t child : children) EXPECT_TRUE(soon([&] { return !lives(child); })) << child;
}

TEST_F(ServerCommands, HelpersAreNotInTheHelp) {
    const std::string help = cli({"--help"}).out;
    EXPECT_NE(help.find("serve"), std::string::npos);
    EXPECT_EQ(help.find("examine"), std::string::npos);
    EXPECT_EQ(cli({"frobnicate"}).err.find("examine"), std::string::npos);
}

}  // namespace
}  // namespace shadowbench::service
