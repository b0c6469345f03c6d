// Measures the settings of a space on one light of a scenario: the lab of shadowbench recommend.
//
// All maps answer the same question. The truth is computed once, from the scenario's own resolution and reference
// settings. A map of another resolution is asked for the same places and the same footprints of the light's plane.
// The time of a build is that of capturing the light rays and of building the map from them, both on one thread: more
// samples a pixel cost both. A family that uses no light rays is not charged for them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "base/parallel.h"
#include "bench/clock.h"
#include "bench/contender.h"
#include "bench/load.h"
#include "bench/progress.h"
#include "bench/queries.h"
#include "bench/ray_store.h"
#include "bench/run.h"
#include "rays/tracer.h"
#include "recommend/error_interval.h"
#include "recommend/exploration.h"
#include "recommend/lab.h"
#include "recommend/space.h"
#include "recommend/trial_files.h"
#include "results/result.h"

namespace shadowbench::recommend {

class Trials final : public Lab {
public:
    // `light`: a name, or a number from 0 on; empty if the scenario has one light. Sweeps over the samples a pixel and
    // over techniques are dropped, since these are explored. Throws what bench::run() throws for a document, and
    // Error{usage} for other sweeps, and for a light that does not exist or is not chosen.
    Trials(const nlohmann::json& document, const bench::RunOptions& options, const std::string& light, Measure measure,
           const bench::ProgressCallback& progress);
    ~Trials() override;

    std::span<const Family> families() const override { return space_->families(); }
    std::optional<std::size_t> scout() const override { return space_->scout(); }
    double effort(const Point& point) const override;
    double least_effort() const override;
    double confirm_effort(const Point& point, std::span<const Point> others) const override;
    double at_least(const Point& point, Cost cost) const override;
    Trial measure(const Point& point) override;
    std::vector<std::optional<double>> time_again(std::span<const Point> points) override;
    std::vector<Confirmed> confirm(std::span<const Point> points, const Confirming& how) override;

    // From now on, measure() takes what is in this folder, and adds what is not (trial_files.h). Throws what TrialFiles
    // throws.
    void keep_in(const std::filesystem::path& folder);
    std::size_t taken() const { return taken_; }                          // trials from the folder
    std::size_t others() const { return files_ ? files_->others() : 0; }  // in it, which do not count here

    const Space& space() const { return *space_; }
    // One more setting to measure: see Space::add.
    Point add(const nlohmann::json& part) { return space_->add(part); }
    const std::string& light() const { return light_->name; }
    double truth_error() const { return truth_doubt_.rms; }  // the standard error of the truth, RMS
    // The width of all footprints as a share of the map, if the scenario gives it in map pixels: a map of another
    // resolution must be asked for this share instead, to answer the same question.
    std::optional<double> footprint_share() const;
    // Everything measured so far, as a run of all these settings would give it: a variant for each resolution and
    // number of samples. Times of settings that were not confirmed are short ones.
    results::Result result() const;

private:
    struct Attempt;
    struct Kept;
    struct Timed;
    bench::RayChoice choice(const Setting& setting, int seed) const;
    const rays::MapLayout& layout(const Setting& setting) const;
    std::string refusal(const Setting& setting, const bench::Contender& contender) const;
    void keep_map(const Setting& setting, Attempt attempt);
    std::list<Kept>::iterator find_kept(const Setting& setting);
    Attempt take_kept(std::list<Kept>::iterator kept, const Setting& setting);
    Attempt build(const Setting& setting, int seed, bool timed);
    void judge_lookups(Attempt& attempt) const;
    void check_some(Attempt& attempt) const;
    void time_quickly(Attempt& attempt) const;
    bench::QuerySet asked(const bench::QuerySet& set, const rays::LightView& view) const;
    double error_of(const results::Cell& cell) const;
    double build_seconds(const Point& point) const;
    double judging_seconds(const Point& point) const;
    const Trial* trial_of(const Point& point) const;
    int seeds_of(const Point& point, double error) const;
    std::size_t lookups_of(const Point& point) const;
    bool time_builds(std::vector<Timed>& timed, int repetitions, const bench::Stopwatch& stopwatch,
                     double most_seconds);
    void plan_lookups(std::vector<Timed>& timed) const;
    void time_lookups(std::vector<Timed>& timed, int least, double longest) const;
    void note_effort(const Setting& setting, double seconds, double rays, double bytes);
    std::string filed_name(const Point& point, const Setting& setting) const;
    Trial take(const FiledTrial& filed, const Point& point, const Setting& setting);
    void file(const Point& point, const Setting& setting, const results::LightResult& light, const results::Cell& cell,
              FiledTrial filed) const;
    results::LightResult* recorded(const Setting& setting);
    results::LightResult& record(const Setting& setting, const bench::StoredRays& rays);
    const results::Cell& keep(results::LightResult& light, const bench::Contender& contender) const;
    static const results::Cell& put_cell(results::LightResult& light, results::Cell cell);
    static results::VariantResult variant_of(const bench::RayChoice& rays, results::LightResult light);
    results::Result result_without_variants() const;

    bench::RunOptions options_;
    base::ThreadLimit threads_;
    std::string document_;
    results::RunTimes times_;  // of the start
    bench::ScenarioLoader loader_;
    bench::ProgressCallback progress_;
    Measure measure_;
    const scene::Scenario* scenario_ = nullptr;
    const scene::Light* light_ = nullptr;
    std::size_t index_ = 0;  // of the light
    std::unique_ptr<rays::Tracer> casters_;
    std::optional<Space> space_;
    std::optional<bench::RayStore> store_;
    std::shared_ptr<const bench::Frame> own_;  // the scenario's own resolution
    bench::QuerySet all_, judged_;             // of the own resolution
    bench::Truth truth_;
    TruthDoubt truth_doubt_;
    mutable std::map<std::pair<int, int>, rays::MapLayout> layouts_;  // by the larger side and the samples
    mutable std::vector<std::vector<double>> least_bytes_;  // of every point of a family; negative: not yet asked for
    struct Effort {
        double seconds = 0.0, rays = 0.0;  // of attempts without their captures
    };
    std::map<const techniques::Technique*, Effort> efforts_;
    // Of maps so large that filling their memory takes most of the time; a guess, until some were built.
    double large_seconds_ = 0.1, large_bytes_ = 1e8;
    std::list<Kept> kept_;  // the last used one first
    std::vector<std::pair<Point, Trial>> trials_;
    std::optional<TrialFiles> files_;
    std::size_t taken_ = 0;
    std::vector<std::pair<bench::RayChoice, results::LightResult>> recorded_;
    double seconds_ = 0.0;
};

}  // namespace shadowbench::recommend
