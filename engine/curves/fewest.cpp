// The search goes over states: behind a group, n vertices are written, the last of them there, and the function goes on
// from a value v. A segment leads from (group, n, v) to a vertex at a later group, in front of it; that is a state with
// n + 1 vertices if the vertex serves on both sides, and a step down makes states with n + 2 of it. Values that are
// reached with one segment from an interval of values are an interval, whose ends Funnel knows. Those from several
// groups together need not be: so each state keeps a list of intervals, nearly always of one.
//
// Few states matter. Let m be the least number of vertices behind group g, reached with the value w.
//  - Where the input has no step, none is needed: in place of its second vertex, one where the function passes the next
//    group does as well.
//  - States of g with n > m + 1 are not needed. Say a function goes on from such a state with the value v. If v <= w, a
//    step from w to v takes m + 1, or, where none may be, a segment to where the function passes the next group.
//    Otherwise a level line from w lies below that function, and so within the tolerance, until the function falls
//    below w, at a step or between two neighbouring groups. A vertex on each side leads from w to it, which makes
//    m + 2 <= n. m never falls from group to group, so this repeats at later groups only, and ends.
//  - A segment that passes a group at a value that is reached there with as many vertices may as well start there.
//  - A state of g with n vertices is not needed if n and what must follow are over budget. What follows is at least the
//    number of lines, not joined to one another, that pass all windows from g on: the fewest such lines are found from
//    the end, each as long as possible.
// With a budget below the fewest there is no function; with any other, the first that is complete has the fewest.
#include "curves/fewest.h"

#include <algorithm>
#include <cmath>

#include "curves/compress.h"
#include "curves/fewest_trace.h"

namespace shadowbench::curves {

namespace {

using namespace fewest;

class Search {
public:
    Search(CurveView curve, float tolerance, FewestScratch& scratch)
        : s_(scratch), groups_(scratch.groups), funnel_(scratch.funnel), back_(scratch.funnel) {
        given_.epsilon = tolerance > 0.0f ? tolerance : 0.0;
        given_.start = curve.front().value;
        given_.slack = 0x1p-46 * given_.start;
        read(curve);
        bound_the_rest();
        std::size_t& flat = given_.flat;
        while (flat + 1 < groups_.size() && given_.start <= std::min(groups_[flat].high, groups_[flat + 1].front))
            ++flat;
    }

    // Finds the function if it takes fewer than `limit` vertices.
    bool find(std::size_t limit) {
        std::size_t budget = 1, more = 1;
        while (earliest(s_, budget - 1) > given_.flat) ++budget;
        while (budget < limit) {
            if (find_within(budget)) return true;
            if (is_over() || budget + 1 == limit) return false;
            budget = std::min(budget + more, limit - 1);
            more *= 2;
        }
        return false;
    }

    // Whether the search has taken more time or memory than it may.
    bool is_over() const { return steps_ > s_.most_steps || s_.pieces.size() > 64 * groups_.size(); }

    std::size_t write(Vertex* out) const {
        const std::vector<Knot>& knots = s_.knots;
        if (knots.size() == 1 && given_.start == 1.0) return 0;
        for (std::size_t i = 0; i < knots.size(); ++i) {
            const Group& group = groups_[knots[i].group];
            const bool steps = i + 1 < knots.size() && knots[i + 1].group == knots[i].group;
            const bool stepped = i > 0 && knots[i - 1].group == knots[i].group;
            const double low = std::max((stepped ? group.after : group.before) - given_.epsilon, 0.0);
            const double high = (steps ? group.before : group.after) + given_.epsilon;
            const double value = i == 0 ? given_.start : std::min(std::max(knots[i].value, low), high);
            const float rounded = static_cast<float>(value);
            out[i] = {static_cast<float>(group.z), i == 0 ? rounded : std::min(rounded, out[i - 1].value)};
        }
        return knots.size();
    }

private:
    void read(CurveView curve) {
        const double epsilon = given_.epsilon, slack = given_.slack;
        groups_.clear();
        s_.pieces.clear();
        for (std::size_t i = 0; i < curve.size();) {
            const Vertex first = curve[i];
            double after = first.value;
            for (++i; i < curve.size() && curve[i].z == first.z; ++i) after = curve[i].value;
            const double before = first.value;
            groups_.push_back({first.z, before, after, std::max(before - epsilon, 0.0) - slack, after + epsilon + slack,
                               before + epsilon + slack, std::max(after - epsilon, 0.0) - slack});
        }
    }

    void bound_the_rest() {
        std::size_t group = 0;
        while (group + 1 < groups_.size() && groups_[group].behind > groups_.back().high) ++group;
        s_.earliest.assign(1, group);
        while (group > 0) {
            back_.start(groups_[group].z, groups_[group].low, groups_[group].front);
            for (--group; group > 0; --group) {
                const Group &passed = groups_[group], &next = groups_[group - 1];
                if (!back_.meets(passed.z, passed.low, passed.high)) break;
                back_.pass(passed.z, passed.low, passed.high);
                if (!back_.meets(next.z, next.behind, next.high)) break;
            }
            s_.earliest.push_back(group);
        }
    }

    bool find_within(std::size_t budget) {
        given_.budget = budget;
        end_ = 0;
        s_.pieces.clear();
        s_.reached.assign(groups_.size(), {});
        for (std::size_t group = 0; group <= given_.flat; ++group) arrive(1, group, given_.start, given_.start);
        for (std::size_t vertices = 1; vertices <= budget; ++vertices) {
            const std::size_t first = earliest(s_, budget - vertices), end = end_;
            if (first >= end) return false;
            const Knot last = finish(vertices, first);
            if (last.group != none) return trace(s_, given_, vertices, last);
            if (vertices == budget) return false;
            steps_ += end - first;
            for (std::size_t group = first; group < end; ++group)
                for (std::size_t piece = first_piece(s_, vertices, group); piece != none;) {
                    if (is_over()) return false;
                    const Piece values = s_.pieces[piece];
                    leave(vertices, group, values.low, values.high);
                    piece = values.next;
                }
        }
        return false;
    }

    // The hot loop: segments from the values [low, high] behind a group to all groups that they reach.
    void leave(std::size_t vertices, std::size_t from, double low, double high) {
        funnel_.start(groups_[from].z, low, high);
        for (std::size_t to = from + 1; to < groups_.size(); ++to) {
            const Group& group = groups_[to];
            ++steps_;
            const double least = std::max(funnel_.lowest(group.z), group.low);
            const double greatest = std::min(funnel_.highest(group.z), group.front);
            if (!(least <= greatest)) return;
            arrive(vertices + 1, to, least, greatest);
            const double passing = std::min(greatest, group.high);
            if (!(least <= passing) || is_reached(vertices, to, least, passing)) return;
            funnel_.pass(group.z, group.low, group.high);
        }
    }

    // A vertex in front of a group takes any value of [low, high].
    void arrive(std::size_t vertices, std::size_t group, double low, double high) {
        const Group& at = groups_[group];
        const double greatest = std::min(high, at.high);
        if (low <= greatest) add(vertices, group, low, greatest);
        if (has_step(at)) add(vertices + 1, group, at.behind, greatest);
    }

    void add(std::size_t vertices, std::size_t group, double low, double high) {
        if (vertices > given_.budget || group < earliest(s_, given_.budget - vertices)) return;
        Reached& at = s_.reached[group];
        if (at.vertices == 0 || vertices < at.vertices) {
            at.first = {none, at.vertices == vertices + 1 ? at.first[0] : none};
            at.vertices = vertices;
        }
        if (vertices - at.vertices > 1) return;
        std::size_t& first = at.first[vertices - at.vertices];
        std::size_t spare = none;  // a piece that is joined with the new one
        for (std::size_t* link = &first; *link != none; ++steps_) {
            Piece& piece = s_.pieces[*link];
            if (piece.low <= low && high <= piece.high) return;
            if (low > piece.high || piece.low > high) {
                link = &piece.next;
                continue;
            }
            low = std::min(low, piece.low);
            high = std::max(high, piece.high);
            spare = *link;
            *link = piece.next;
        }
        if (spare == none) {
            spare = s_.pieces.size();
            s_.pieces.push_back({});
        }
        s_.pieces[spare] = {low, high, first};
        first = spare;
        end_ = std::max(end_, group + 1);
    }

    bool is_reached(std::size_t vertices, std::size_t group, double low, double high) {
        for (std::size_t piece = first_piece(s_, vertices, group); piece != none; piece = s_.pieces[piece].next) {
            if (s_.pieces[piece].low <= low && high <= s_.pieces[piece].high) return true;
            ++steps_;
        }
        return false;
    }

    // The last vertex of a function with so many, if it may go on level from there; else none.
    Knot finish(std::size_t vertices, std::size_t first) const {
        const Group& end = groups_.back();
        Knot best{none, 0.0};
        for (std::size_t group = first; group < end_; ++group)
            for (std::size_t piece = first_piece(s_, vertices, group); piece != none; piece = s_.pieces[piece].next) {
                const Piece& values = s_.pieces[piece];
                if (!(values.low <= end.high)) continue;
                const double value = std::min(std::max(end.after, values.low), std::min(values.high, end.high));
                if (best.group == none || std::abs(value - end.after) < std::abs(best.value - end.after))
                    best = {group, value};
            }
        return best;
    }

    FewestScratch& s_;
    std::vector<Group>& groups_;
    Funnel& funnel_;
    BackwardFunnel back_;
    Problem given_;
    std::size_t end_ = 0;    // no group from here on is reached
    std::size_t steps_ = 0;  // taken so far, with all budgets
};

}  // namespace

std::size_t FewestScratch::bytes() const {
    return groups.capacity() * sizeof(Group) + earliest.capacity() * sizeof(std::size_t) +
           reached.capacity() * sizeof(Reached) + pieces.capacity() * sizeof(Piece) + knots.capacity() * sizeof(Knot) +
           plain.capacity() * sizeof(Vertex) + funnel.bytes();
}

std::size_t compress_to_fewest(CurveView curve, float tolerance, FewestScratch& scratch, Vertex* out) {
    scratch.complete = true;
    if (curve.empty()) return 0;
    scratch.plain.resize(curve.size());
    const std::size_t count = compress(curve, tolerance, scratch.plain.data());
    if (count > 1) {
        Search search(curve, tolerance, scratch);
        if (search.find(count)) return search.write(out);
        scratch.complete = !search.is_over();
    }
    std::copy_n(scratch.plain.begin(), count, out);
    return count;
}

Curve compress_to_fewest(CurveView curve, float tolerance) {
    FewestScratch scratch;
    Curve out(curve.size());
    out.resize(compress_to_fewest(curve, tolerance, scratch, out.data()));
    return out;
}

}  // namespace shadowbench::curves
