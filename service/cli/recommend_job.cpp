#include "service/cli/recommend_job.h"

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/write_files.h"
#include "bench/clock.h"
#include "recommend/recommendation.h"
#include "results/report.h"

namespace shadowbench::service {
namespace {

// How far a recommendation is: its time against the budget, which the truth counts to.
class Course {
public:
    Course(double budget, const JobProgressCallback& report) : budget_(budget), report_(report) {}

    // The truth, or a step of confirming.
    void measure(const bench::Progress& progress) {
        if (began_)
            report_budget();
        else
            report_(progress, fraction());
    }

    void explore(const recommend::Progress& progress) {
        began_ = true;
        stage_ = progress.stage == recommend::Stage::confirming ? "confirming" : "exploring";
        report_budget();
    }

private:
    double fraction() const {
        const double now = since_start_.seconds();
        return std::min(now / budget_, 1.0);
    }
    void report_budget() const {
        const double spent = std::min(since_start_.seconds(), budget_);
        report_({"", stage_, static_cast<std::size_t>(spent), static_cast<std::size_t>(budget_)}, fraction());
    }

    double budget_;
    const JobProgressCallback& report_;
    bench::Stopwatch since_start_;
    bool began_ = false;  // exploring
    const char* stage_ = "exploring";
};

// A budget that is too short is bad input of the request.
recommend::Explored explored_as_asked(const nlohmann::json& document, const bench::RunOptions& options,
                                      const recommend::Request& asked, const recommend::Watch& watch) try {
    return recommend::explore(document, options, asked, watch);
} catch (const base::Error& error) {
    if (error.where() != "--budget") throw;
    throw base::Error(base::ErrorCode::bad_input, "/recommend/budget", error.message());
}

}  // namespace

bool recommend_job(const nlohmann::json& document, const nlohmann::json& request, const bench::RunOptions& options,
                   const std::filesystem::path& folder, const std::vector<HiddenFolder>& hidden,
                   const JobProgressCallback& report) {
    std::vector<base::Error> faults;
    const recommend::Request asked = recommend::read_request(request, "/recommend", faults);
    if (!faults.empty()) throw base::Error(faults.front());
    Course course(asked.goal.budget, report);
    recommend::Watch watch;
    watch.measuring = [&](const bench::Progress& progress) { course.measure(progress); };
    watch.exploring = [&](const recommend::Progress& progress, double) { course.explore(progress); };
    recommend::Explored explored = explored_as_asked(document, options, asked, watch);
    for (std::string& note : explored.result.notes) note = hide(note, hidden);
    nlohmann::ordered_json result = recommend::to_json(explored);
    result["recommendation"]["request"] = request;
    const recommend::AnswerText answer = recommend::answer_text(explored.recommendation, asked.goal);
    base::write_files({{folder / "result.json", result.dump(1) + "\n"},
                       {folder / "result.csv", results::to_csv(explored.result)},
                       {folder / "table.txt", answer.text}});
    return answer.reached;
}

}  // namespace shadowbench::service
