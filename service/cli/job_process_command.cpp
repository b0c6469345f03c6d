#include "service/cli/job_process_command.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <new>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/read_text.h"
#include "base/write_files.h"
#include "bench/run.h"
#include "document/document.h"
#include "results/report.h"
#include "results/write_result.h"
#include "scene/scenario.h"
#include "service/cli/job_pictures.h"
#include "service/cli/libraries.h"
#include "service/cli/recommend_job.h"
#include "service/jobs/fraction.h"
#include "service/jobs/progress_line.h"
#include "service/privacy/hidden_folders.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;
using base::Error;
using base::ErrorCode;

constexpr std::chrono::milliseconds between_lines{100};

// Writes lines of progress: the first of each stage, and at most ten per second of the others.
class Reporter {
public:
    explicit Reporter(std::ostream& out) : out_(out) {}

    void report(const bench::Progress& progress, double fraction) {
        const auto now = std::chrono::steady_clock::now();
        if (progress.stage == stage_ && progress.place == place_ && now - reported_ < between_lines) return;
        reported_ = now;
        stage_ = progress.stage;
        place_ = progress.place;
        out_ << progress_line(progress, fraction) << '\n' << std::flush;
    }

private:
    std::ostream& out_;
    std::chrono::steady_clock::time_point reported_{};
    std::string stage_, place_;
};

// What the job writes only for a while lies in its folder too, so that a full disk is a fault of one storage.
class TemporaryPlace {
public:
    explicit TemporaryPlace(const std::string& folder) {
        if (const char* before = std::getenv(name)) before_ = before;
        ::setenv(name, folder.c_str(), 1);
    }
    ~TemporaryPlace() {
        if (before_)
            ::setenv(name, before_->c_str(), 1);
        else
            ::unsetenv(name);
    }
    TemporaryPlace(const TemporaryPlace&) = delete;
    TemporaryPlace& operator=(const TemporaryPlace&) = delete;

private:
    static constexpr const char* name = "TMPDIR";
    std::optional<std::string> before_;
};

// The number of maps of a variant; 1 if it is not a scenario, which fails when it is loaded.
std::size_t lights_of(const document::Variant& variant) {
    const nlohmann::json& document = *variant.document;
    if (!scene::schema_faults(document, scene::scenario_schema(), 1).empty()) return 1;
    return std::max<std::size_t>(scene::light_names(document).size(), 1);
}

JobFraction make_fraction(const std::vector<document::Variant>& variants, bool pictures) {
    std::size_t lights = 0;
    for (const document::Variant& variant : variants) lights += lights_of(variant);
    return {lights, pictures ? lights_of(variants.front()) : 0};
}

// Draws into `folder`. Clients can read the fault that it leaves there.
void draw(const nlohmann::json& document, const bench::RunOptions& run, const fs::path& folder,
          const std::vector<HiddenFolder>& hidden, const bench::ProgressCallback& progress) {
    if (const auto fault = draw_pictures(document, run, folder, progress))
        base::write_files({{folder / "error.json", error_line(hide(*fault, hidden)) + "\n"}});
}

// Whether the place of an error is in the job's own folder, which is the server's storage.
bool is_in(const std::string& folder, const std::string& place) {
    const std::string printed = Error(ErrorCode::io, folder, "").where();  // as errors write it
    return place == printed || place.starts_with(printed + "/");
}

// Whether storage failed. An error that any disk would report, such as a name that is too long, is the job's fault.
bool is_of_storage(const std::error_code& why) {
    for (const std::errc job_fault :
         {std::errc::filename_too_long, std::errc::file_too_large, std::errc::invalid_argument,
          std::errc::is_a_directory, std::errc::not_a_directory, std::errc::file_exists})
        if (why == job_fault) return false;
    return static_cast<bool>(why);
}

// The fault of the server's storage that the error means; nothing for a fault of the job.
std::optional<StorageFault> storage_fault(const Error& error, const std::string& folder) {
    if (!is_in(folder, error.where())) return std::nullopt;
    if (const auto* write = dynamic_cast<const base::WriteError*>(&error))
        return is_of_storage(write->why()) ? std::optional(StorageFault{error.what(), write->bytes()}) : std::nullopt;
    // A temporary folder is gone now, and nobody knows how much space it took: the job would start again without end.
    if (error.where().starts_with(Error(ErrorCode::io, folder + "/shadowbench-", "").where())) return std::nullopt;
    const bool file_fault = error.code() == ErrorCode::io || error.code() == ErrorCode::no_such_file;
    return file_fault ? std::optional(StorageFault{error.what(), 0}) : std::nullopt;
}

bool run_job(const JobProcessArguments& arguments, std::ostream& out) {
    const fs::path folder = arguments.folder;
    load_libraries(arguments.libraries, arguments.memory_limit);
    const TemporaryPlace temporary(arguments.folder);
    const nlohmann::json document = scene::parse_json(base::read_text(folder / "scenario.json"), "scenario.json");
    bench::RunOptions options;
    options.data = scene::SearchPath::confined_to({arguments.data.begin(), arguments.data.end()});
    options.limits.all = static_cast<std::size_t>(arguments.memory_limit * 1024.0 * 1024.0 * 1024.0);
    options.limits.kept_rays = std::min(options.limits.kept_rays, options.limits.all / 2);

    const std::vector<HiddenFolder> hidden = hidden_folders(arguments.folder, arguments.data);
    Reporter reporter(out);
    if (const fs::path asked = folder / "recommend.json"; fs::exists(asked))
        return recommend_job(
            document, scene::parse_json(base::read_text(asked), "recommend.json"), options, folder, hidden,
            [&](const bench::Progress& progress, double fraction) { reporter.report(progress, fraction); });

    const std::vector<document::Variant> variants = document::expand(document);
    const bool pictures = arguments.pictures && has_view(*variants.front().document);
    JobFraction fraction = make_fraction(variants, pictures);
    bool kept = true;
    {
        results::Result result = bench::run(document, options, [&](const bench::Progress& progress) {
            reporter.report(progress, fraction.measuring(progress));
        });
        for (std::string& note : result.notes) note = hide(note, hidden);
        base::write_files({{folder / "table.txt", results::to_fitting_table(result) + results::meaning_text(result)}});
        results::write_result(folder, result);
        kept = !results::any_failed(result);
    }
    if (pictures)
        draw(document, options, pictures_folder(folder), hidden,
             [&](const bench::Progress& progress) { reporter.report(progress, fraction.picturing(progress)); });
    return kept;
}

}  // namespace

bool job_process_command(const JobProcessArguments& arguments, std::ostream& out) {
    const auto report = [&](const Error& error) { out << error_line(error) << '\n' << std::flush; };
    try {
        return run_job(arguments, out);
    } catch (const Error& error) {
        if (const auto fault = storage_fault(error, arguments.folder))
            out << storage_line(*fault) << '\n' << std::flush;
        else
            report(error);
        throw;
    } catch (const std::bad_alloc&) {
        report({ErrorCode::internal, "", "out of memory; use a smaller map or fewer samples"});
        throw;
    } catch (const std::exception&) {  // clients do not get its text
        report({ErrorCode::internal, "", "internal fault"});
        throw;
    }
}

}  // namespace shadowbench::service
