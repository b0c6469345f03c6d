// Manual pages, and what shells complete.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "base/read_text.h"
#include "service/run_cli.h"
#include "temporary_folder.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

std::set<std::string> words_of(const std::string& text) {
    std::istringstream stream(text);
    std::set<std::string> words;
    for (std::string word; stream >> word;) words.insert(word);
    return words;
}

class HelpFiles : public ::testing::Test {
protected:
    static void SetUpTestSuite() { ASSERT_EQ(cli({"help-files", "--out", share().string()}).code, 0); }
    static const fs::path& share() {
        static const TemporaryFolder folder;
        static const fs::path path = folder.path() / "share";
        return path;
    }
    static std::string text_of(const std::string& name) { return base::read_text(share() / name); }

    // What a command of a shell prints, also as errors.
    static std::string shell(const std::string& command) {
        std::string text;
        FILE* pipe = popen((command + " 2>&1").c_str(), "r");
        if (!pipe) return "popen failed";
        for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
        pclose(pipe);
        return text;
    }
    // What bash proposes for the last of these words, where shadowbench is this function of the shell.
    static std::set<std::string> completed(
        const std::vector<std::string>& words,
        const std::string& listing = "printf 'tiny  A ball.\\n      tiny.json\\ntwo$(echo ran >&2)  Hostile.\\n'") {
        std::string script = ". '" + (share() / "bash-completion/completions/shadowbench").string() +
                             "'\nshadowbench() { " + listing + "; }\nCOMP_WORDS=(";
        for (const std::string& word : words) script += "'" + word + "' ";
        script += ")\nCOMP_CWORD=" + std::to_string(words.size() - 1) + "\n_shadowbench\necho \"${COMPREPLY[@]}\"\n";
        std::ofstream(share().parent_path() / "script") << script;
        return words_of(shell("bash '" + (share().parent_path() / "script").string() + "'"));
    }
};

// Otherwise a manual page would miss what --help has.
TEST_F(HelpFiles, have_a_page_with_every_option_of_every_command) {
    const std::string page = text_of("man/man1/shadowbench.1");
    std::size_t commands = 0;
    for (const auto& entry : fs::directory_iterator(share() / "man/man1")) {
        const std::string name = entry.path().stem().string();
        if (name == "shadowbench") continue;
        ++commands;
        const std::string command = name.substr(std::string("shadowbench-").size());
        EXPECT_THAT(page, HasSubstr("\n.TP\n\\fB" + command + "\\fR\n"));
        const std::string help = cli({command, "--help"}).out, text = base::read_text(entry.path());
        for (std::string word : words_of(help.substr(help.find("\nOptions:"), help.find("\nExample")))) {
            if (word.rfind("--", 0) != 0 || word.size() < 4) continue;
            word = word.substr(0, word.find_first_of(",.;:)=]"));
            std::string escaped;
            for (const char c : word) escaped += c == '-' ? std::string("\\-") : std::string(1, c);
            EXPECT_THAT(text, HasSubstr(escaped)) << name;
        }
        EXPECT_THAT(text, HasSubstr("\n.SH EXAMPLES\n"));
    }
    EXPECT_GE(commands, 19u);
    EXPECT_THAT(page, Not(HasSubstr("help\\-files"))) << "what --help hides";
    EXPECT_FALSE(fs::exists(share() / "man/man1/shadowbench-examine.1"));
}

TEST_F(HelpFiles, have_pages_that_man_can_format) {
    if (shell("command -v groff").empty()) GTEST_SKIP() << "groff is not installed";
    const std::string pages = (share() / "man/man1").string();
    const std::string text = shell("groff -man -Tascii -P-cbu -rLL=78n '" + pages + "/shadowbench-run.1'");
    EXPECT_THAT(text, HasSubstr("--memory-limit FLOAT"));
    EXPECT_THAT(text, HasSubstr("shadowbench run scenarios/hard --verdicts"));
    EXPECT_THAT(text, Not(HasSubstr("warning")));
    EXPECT_EQ(shell("for page in '" + pages +
                    "'/*; do groff -man -wmac -wescape -wsyntax -wfont -wmissing -z \"$page\"; done"),
              "")
        << "warnings of groff";
}

TEST_F(HelpFiles, complete_commands_options_and_values_in_bash) {
    EXPECT_THAT(completed({"shadowbench", "re"}),
                testing::UnorderedElementsAre("recommend", "render", "report", "reproduce"));
    EXPECT_THAT(completed({"shadowbench", "run", "--o"}), testing::UnorderedElementsAre("--only", "--out"));
    EXPECT_THAT(completed({"shadowbench", "run", "--only", "de"}), testing::UnorderedElementsAre("deep"));
    EXPECT_THAT(completed({"shadowbench", "recommend", "x", "--measure", ""}),
                testing::UnorderedElementsAre("rms", "max", "p99", "curve"));
    EXPECT_THAT(completed({"shadowbench", "recommend", "--measure", "=", "c"}), testing::UnorderedElementsAre("curve"));
    EXPECT_THAT(completed({"shadowbench", "list", ""}), testing::UnorderedElementsAre("techniques", "scenarios"));
    EXPECT_THAT(completed({"shadowbench", "run", "t"}), testing::UnorderedElementsAre("tiny"))
        << "names of scenarios, of which none runs as a command";
    EXPECT_THAT(completed({"shadowbench", "run", "--out", ""}), testing::IsEmpty()) << "files, which bash knows";
    EXPECT_THAT(completed({"shadowbench", "help"}), testing::IsEmpty()) << "what --help hides";
}

// Otherwise a change of the list would leave scenarios without completion.
TEST_F(HelpFiles, complete_the_scenarios_that_the_program_lists) {
    const fs::path folder = share().parent_path();
    std::ofstream(folder / "own.json") << R"({"name": "own_ball", "purpose": "A ball.", "scene": {"objects": []}})";
    const char* const before = std::getenv("SHADOWBENCH_SCENARIOS");
    const std::string others = before ? before : "";
    setenv("SHADOWBENCH_SCENARIOS", folder.c_str(), 1);
    std::ofstream(folder / "list") << cli({"list", "scenarios"}).out;
    before ? setenv("SHADOWBENCH_SCENARIOS", others.c_str(), 1) : unsetenv("SHADOWBENCH_SCENARIOS");
    const std::string listing = "[ \"$*\" = 'list scenarios' ] && cat '" + (folder / "list").string() + "'";
    EXPECT_THAT(completed({"shadowbench", "run", "own_"}, listing), testing::UnorderedElementsAre("own_ball"));
    EXPECT_THAT(completed({"shadowbench", "validate", "own_"}, listing), testing::UnorderedElementsAre("own_ball"));
    EXPECT_THAT(completed({"shadowbench", "run", "--pic"}, listing), testing::UnorderedElementsAre("--pictures"));
}

TEST_F(HelpFiles, can_be_read_by_other_shells_that_are_installed) {
    const std::string zsh = text_of("zsh/site-functions/_shadowbench");
    const std::string fish = text_of("fish/vendor_completions.d/shadowbench.fish");
    EXPECT_THAT(zsh, HasSubstr("'*--only=[Use only techniques of this type]:TEXT:(shadow_map"));
    EXPECT_THAT(fish, HasSubstr("'__fish_seen_subcommand_from run' -l only -x -a 'shadow_map"));
    const auto faults = [](const std::string& program, const std::string& file) {
        if (shell("command -v " + program).empty()) return std::string();
        return shell(program + " -n '" + (share() / file).string() + "'");
    };
    EXPECT_EQ(faults("zsh", "zsh/site-functions/_shadowbench"), "");
    EXPECT_EQ(faults("fish", "fish/vendor_completions.d/shadowbench.fish"), "");
}

TEST_F(HelpFiles, are_printed_one_by_one) {
    EXPECT_EQ(cli({"help-files", "man/man1/shadowbench.1"}).out, text_of("man/man1/shadowbench.1"));
    const Outcome wrong = cli({"help-files", "man/man1/shadowbench.2"});
    EXPECT_EQ(wrong.code, 64);
    EXPECT_THAT(wrong.err, HasSubstr("perhaps \"man/man1/shadowbench.1\"; there are: man/man1/shadowbench.1, "));
}

}  // namespace
}  // namespace shadowbench::service
