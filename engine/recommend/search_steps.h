// The steps of a search, which share what it knows. Internal to explore(): search.cpp has the order and the confirming,
// climbing.cpp and refining.cpp have what their names say.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "recommend/floors.h"
#include "recommend/incumbents.h"
#include "recommend/knowledge.h"
#include "recommend/search.h"

namespace shadowbench::recommend {

class Search {
public:
    Search(Lab& lab, const Goal& goal, const Hooks& hooks);

    Exploration run();

private:
    bool cancelled();
    bool stopped();
    bool exploring_over();
    double whole_time() const;
    double left() const;
    double left_to_explore() const { return left() - reserve_; }
    double reserve() const;
    bool fits(double seconds) const { return seconds <= left_to_explore(); }
    void measure(const Point& point);
    void note_floor(const Point& point, double error);
    void tell_alike(const Point& point, double error);
    std::array<double, costs> limits(std::size_t family) const;
    void update_one(std::size_t family);
    void update(std::size_t family);
    void update_all();

    bool too_dear(std::size_t family, std::size_t index) const;
    bool too_few_rays(std::size_t family, const Point& point) const;
    std::optional<std::size_t> next_climb(std::size_t family) const;
    void climb();

    struct Open {
        std::size_t index;
        double gain;
    };
    std::optional<Point> best_witness() const;
    void probe();
    void probe_light_rays();
    void probe_own_axes();
    void probe_at(const Point& point);
    double gain(std::size_t family, std::size_t index, bool likely) const;
    bool answered() const;
    const std::vector<Open>& open_points(std::size_t family);
    void share_floors(std::size_t family);
    std::optional<Point> most_promising(std::size_t& open, double& skipped);
    std::optional<Point> seemingly_most_promising(std::size_t& open, double& skipped);
    std::optional<Point> open_neighbour(double& skipped) const;
    void refine();
    std::optional<Point> open_variant() const;
    void try_variants();

    void time_again();
    bool is_timed_again(const Point& point) const;
    bool time_in_turns(const std::vector<Point>& points);
    bool is_best(const Point& point) const;
    bool is_confirmed(const Point& point) const;
    std::vector<Point> affordable(const ToConfirm& wanted, double seconds);
    void confirm();
    void go_on();
    void note_next();

    void report(Stage stage, std::size_t open) const;

    Lab& lab_;
    const Hooks& hooks_;
    double began_;
    double reserve_ = 0.0;  // seconds that exploring leaves for what follows
    // Seconds of the shortest step that the last climb, and the last refining, left out since it took too long;
    // infinite if there was none.
    double skipped_climb_ = std::numeric_limits<double>::infinity(),
           skipped_point_ = std::numeric_limits<double>::infinity();
    double spent_ = 1e-9;  // seconds of measuring, as foreseen
    Exploration found_;
    Wanted wanted_;
    std::vector<Knowledge> families_;
    Floors floors_;
    std::vector<std::size_t> shared_;  // the version of the floors that each family was brought up to date with
    struct Climb {
        std::vector<Point> rungs;
        std::size_t next = 0;      // the first rung not yet tried
        std::size_t measured = 0;  // rungs: the first records of the family
    };
    std::vector<Climb> climbs_;                           // of every family
    std::vector<std::optional<std::vector<Open>>> open_;  // of every family; nothing if it must be found again
    Incumbents incumbents_{};
    bool fine_ = false;  // whether all points count, or only coarse ones
};

// Whether the steps of axes 0 and 1 are the same light rays in both.
inline bool same_light_rays(const Family& a, const Family& b) {
    return a.axes[0].values == b.axes[0].values && a.axes[1].values == b.axes[1].values;
}

}  // namespace shadowbench::recommend
