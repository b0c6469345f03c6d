#include "service/cli/progress_bar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <ostream>
#include <sstream>
#include <streambuf>
#include <string>

namespace shadowbench::service {
namespace {

using namespace std::chrono_literals;
using Style = ProgressBar::Style;

// What is written so far, and waiting for more: another thread writes.
class Written : public std::streambuf {
public:
    std::string wait_for(std::size_t count, char what) {
        std::unique_lock lock(mutex_);
        more_.wait(lock,
                   [&] { return static_cast<std::size_t>(std::count(text_.begin(), text_.end(), what)) >= count; });
        return text_;
    }
    std::string text() {
        const std::lock_guard lock(mutex_);
        return text_;
    }

protected:
    int overflow(int c) override {
        const char one = static_cast<char>(c);
        xsputn(&one, 1);
        return c;
    }
    std::streamsize xsputn(const char* text, std::streamsize count) override {
        const std::lock_guard lock(mutex_);
        text_.append(text, static_cast<std::size_t>(count));
        more_.notify_all();
        return count;
    }

private:
    std::mutex mutex_;
    std::condition_variable more_;
    std::string text_;
};

TEST(ProgressBar, LinesComeWhileOnePieceOfWorkGoesOn) {
    Written written;
    std::ostream stream(&written);
    ProgressBar lines(stream, Style::lines, 1ms);
    EXPECT_EQ(written.wait_for(2, '\n').rfind("progress: preparing, 0 s\n", 0), 0u);
    lines.show({"2/5 key", "build", 3, 7});
    const std::string before = written.text();
    written.wait_for(static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 3, '\n');
    lines.end();
    const std::string text = written.text();
    EXPECT_NE(text.find("progress: 2/5 key build 3/7, "), std::string::npos) << text;
    EXPECT_EQ(text.find('\r'), std::string::npos) << text;
    EXPECT_EQ(text.back(), '\n');
    lines.show({"", "lookups", 1, 1});
    EXPECT_EQ(written.text(), text) << "nothing after the end";
}

TEST(ProgressBar, ABarIsDrawnOverAndGoneAtTheEnd) {
    Written written;
    std::ostream stream(&written);
    {
        ProgressBar bar(stream, Style::bar, 1ms);
        bar.show({"key", "build", 2, 4});
        bar.show({"key", "build", 4, 4});
        written.wait_for(4, '\r');
    }
    const std::string text = written.text();
    EXPECT_NE(text.find("\r[##############################] key build 4/4, "), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
    EXPECT_EQ(text.back(), '\r') << "the cursor is back";
    const std::size_t last = text.rfind('\r', text.size() - 2);
    EXPECT_EQ(text.find_first_not_of(' ', last + 1), text.size() - 1) << "and the line is blank";
}

TEST(ProgressBar, AStreamThatIsNotStandardErrorStaysEmpty) {
    std::ostringstream stream;
    ProgressBar bar(stream);
    bar.show({"key", "build", 4, 4});
    bar.end();
    EXPECT_EQ(stream.str(), "");
}

}  // namespace
}  // namespace shadowbench::service
