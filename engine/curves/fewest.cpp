// The search goes over states: behind a group, n vertices are written, the last of them there, and the function goes on
// from a value v. A segment leads from (group, n, v) to a vertex at a later group, in front of it; that is a state with
// n + 1 vertices if the vertex serves on both sides, and a step down makes states with n + 2 of it. Values that are
// reached with one segment from an interval of values are an interval, whose ends Funnel knows. Those from several
// groups together need not be: so each state keeps a list of intervals, nearly always of one.
//
// Few states matter. Let m be the least number of vertices behind group g, reached with the value w.
//  - States of g with n > m + 1 are not needed. Say a function goes on from such a state with the value v. If v <= w, a
//    step from w to v takes m + 1. Otherwise a level line from w lies below that function, and so within the tolerance,
//    until the function falls below w between two neighbouring groups. A vertex at each of these leads from w to it,
//    which makes m + 2 <= n. m never falls from group to group, so this repeats at later groups only, and ends.
//  - A segment that passes a group at a value that is reached there with as many vertices may as well start there.
//  - A state of g with n vertices is not needed if n and what must follow are over budget. What follows is at least the
//    number of lines, not joined to one another, that pass all windows from g on: the fewest such lines are found from
//    the end, each as long as possible.
// With a budget below the fewest there is no function; with any other, the first that is complete has the fewest.
#include "curves/fewest.h"

#include <algorithm>
#include <cmath>

#include "curves/compress.h"

namespace shadowbench::curves {

namespace {

using Group = FewestScratch::Group;
using Knot = FewestScratch::Knot;
using Piece = FewestScratch::Piece;
using Reached = FewestScratch::Reached;
constexpr std::size_t none = FewestScratch::none;

// A segment that ends in front of a given group.
struct Link {
    std::size_t group;  // behind which it starts; none: there is no such segment
    double from, to;    // its values
};

class Search {
public:
    Search(CurveView curve, float tolerance, FewestScratch& scratch)
        : s_(scratch),
          groups_(scratch.groups),
          funnel_(scratch.funnel),
          epsilon_(tolerance > 0.0f ? tolerance : 0.0),
          start_(curve.front().value),
          slack_(0x1p-46 * start_) {
        read(curve);
        bound_the_rest();
        while (flat_ + 1 < groups_.size() && start_ <= groups_[flat_].high && start_ <= groups_[flat_ + 1].front)
            ++flat_;
    }

    // Finds the function if it takes fewer than `limit` vertices.
    bool find(std::size_t limit) {
        std::size_t budget = 1, more = 1;
        while (earliest(budget - 1) > flat_) ++budget;
        while (budget < limit) {
            if (find_within(budget)) return true;
            if (budget + 1 == limit) return false;
            budget = std::min(budget + more, limit - 1);
            more *= 2;
        }
        return false;
    }

    std::size_t write(Vertex* out) const {
        const std::vector<Knot>& knots = s_.knots;
        if (knots.size() == 1 && start_ == 1.0) return 0;
        for (std::size_t i = 0; i < knots.size(); ++i) {
            const Group& group = groups_[knots[i].group];
            const bool steps = i + 1 < knots.size() && knots[i + 1].group == knots[i].group;
            const bool stepped = i > 0 && knots[i - 1].group == knots[i].group;
            const double low = std::max((stepped ? group.after : group.before) - epsilon_, 0.0);
            const double high = (steps ? group.before : group.after) + epsilon_;
            const double value = i == 0 ? start_ : std::min(std::max(knots[i].value, low), high);
            const float rounded = static_cast<float>(value);
            out[i] = {static_cast<float>(group.z), i == 0 ? rounded : std::min(rounded, out[i - 1].value)};
        }
        return knots.size();
    }

private:
    void read(CurveView curve) {
        groups_.clear();
        for (std::size_t i = 0; i < curve.size();) {
            const Vertex first = curve[i];
            double after = first.value;
            for (++i; i < curve.size() && curve[i].z == first.z; ++i) after = curve[i].value;
            const double before = first.value;
            groups_.push_back({first.z, before, after, std::max(before - epsilon_, 0.0) - slack_,
                               after + epsilon_ + slack_, before + epsilon_ + slack_,
                               std::max(after - epsilon_, 0.0) - slack_});
        }
    }

    // No group before this one can do with so few more vertices.
    std::size_t earliest(std::size_t vertices) const {
        return vertices < s_.earliest.size() ? s_.earliest[vertices] : 0;
    }

    void bound_the_rest() {
        std::size_t group = 0;
        while (group + 1 < groups_.size() && groups_[group].behind > groups_.back().high) ++group;
        s_.earliest.assign(1, group);
        while (group > 0) {
            look_back(group, groups_[group].low, groups_[group].front);
            for (--group; group > 0; --group) {
                const Group &passed = groups_[group], &next = groups_[group - 1];
                if (!passes(passed.z, passed.low, passed.high)) break;
                funnel_.pass(-passed.z, -passed.high, -passed.low);
                if (!passes(next.z, next.behind, next.high)) break;
            }
            s_.earliest.push_back(group);
        }
    }

    // Seen from the end, with depths and values negated, lines that do not rise do not rise either.
    void look_back(std::size_t group, double low, double high) { funnel_.start(-groups_[group].z, -high, -low); }
    double least_back(double z) const { return -funnel_.highest(-z); }
    double greatest_back(double z) const { return -funnel_.lowest(-z); }
    bool passes(double z, double low, double high) const {
        return std::max(low, least_back(z)) <= std::min(high, greatest_back(z));
    }

    bool find_within(std::size_t budget) {
        budget_ = budget;
        end_ = 0;
        s_.pieces.clear();
        s_.reached.assign(groups_.size(), {});
        for (std::size_t group = 0; group <= flat_; ++group) arrive(1, group, start_, start_);
        for (std::size_t vertices = 1; vertices <= budget; ++vertices) {
            const std::size_t first = earliest(budget - vertices), end = end_;
            if (first >= end) return false;
            const Knot last = finish(vertices, first);
            if (last.group != none) return trace(vertices, last);
            if (vertices == budget) return false;
            for (std::size_t group = first; group < end; ++group)
                for (std::size_t piece = first_piece(vertices, group); piece != none;) {
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
        add(vertices + 1, group, at.behind, greatest);
    }

    void add(std::size_t vertices, std::size_t group, double low, double high) {
        if (vertices > budget_ || group < earliest(budget_ - vertices)) return;
        Reached& at = s_.reached[group];
        if (at.vertices == 0 || vertices < at.vertices) {
            at.first = {none, at.vertices == vertices + 1 ? at.first[0] : none};
            at.vertices = vertices;
        }
        if (vertices - at.vertices > 1) return;
        std::size_t& first = at.first[vertices - at.vertices];
        std::size_t spare = none;  // a piece that is joined with the new one
        for (std::size_t* link = &first; *link != none;) {
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

    std::size_t first_piece(std::size_t vertices, std::size_t group) const {
        const Reached& at = s_.reached[group];
        return at.vertices != 0 && vertices - at.vertices <= 1 ? at.first[vertices - at.vertices] : none;
    }

    bool is_reached(std::size_t vertices, std::size_t group, double low, double high) const {
        for (std::size_t piece = first_piece(vertices, group); piece != none; piece = s_.pieces[piece].next)
            if (s_.pieces[piece].low <= low && high <= s_.pieces[piece].high) return true;
        return false;
    }

    // The last vertex of a function with so many, if it may go on level from there; else none.
    Knot finish(std::size_t vertices, std::size_t first) const {
        const Group& end = groups_.back();
        Knot best{none, 0.0};
        for (std::size_t group = first; group < end_; ++group)
            for (std::size_t piece = first_piece(vertices, group); piece != none; piece = s_.pieces[piece].next) {
                const Piece& values = s_.pieces[piece];
                if (!(values.low <= end.high)) continue;
                const double value = std::min(std::max(end.after, values.low), std::min(values.high, end.high));
                if (best.group == none || std::abs(value - end.after) < std::abs(best.value - end.after))
                    best = {group, value};
            }
        return best;
    }

    // Goes back from the last vertex and chooses all others. Returns false if none fits, which only rounding could do.
    bool trace(std::size_t vertices, const Knot& last) {
        s_.knots.assign(1, last);
        while (vertices > 1) {
            const Knot to = s_.knots.back();
            const Group& group = groups_[to.group];
            Link link{none, 0.0, 0.0};
            if (group.low <= to.value && to.value <= group.high)
                link = link_to(to.group, to.value, to.value, vertices - 1);
            if (link.group != none) {
                --vertices;
            } else if (vertices == 2) {  // the first vertex, and a step
                if (to.group > flat_) return false;
                s_.knots.push_back({to.group, start_});
                break;
            } else {
                link = link_to(to.group, std::max(to.value, group.low), group.front, vertices - 2);
                if (link.group == none) return false;
                s_.knots.push_back({to.group, link.to});
                vertices -= 2;
            }
            s_.knots.push_back({link.group, link.from});
        }
        std::reverse(s_.knots.begin(), s_.knots.end());
        return true;
    }

    // A segment to [low, high] in front of a group from what is reached with so many vertices. Of the values at its
    // ends it takes those nearest to the input.
    Link link_to(std::size_t to, double low, double high, std::size_t vertices) {
        look_back(to, low, high);
        for (std::size_t group = to; group-- > earliest(budget_ - vertices);) {
            const Group& at = groups_[group];
            const double least = least_back(at.z) - slack_, greatest = greatest_back(at.z) + slack_;
            for (std::size_t piece = first_piece(vertices, group); piece != none; piece = s_.pieces[piece].next) {
                const double lowest = std::max(least, s_.pieces[piece].low);
                const double highest = std::min(greatest, s_.pieces[piece].high);
                if (!(lowest <= highest)) continue;
                const double from = std::min(std::max(at.after, lowest), highest);
                return {group, from, end_of(group, from, to, low, high)};
            }
            if (!passes(at.z, at.low - slack_, at.high + slack_)) break;
            funnel_.pass(-at.z, -at.high - slack_, -at.low + slack_);
        }
        return {none, 0.0, 0.0};
    }

    // Where in [low, high] a segment from this value ends.
    double end_of(std::size_t group, double from, std::size_t to, double low, double high) const {
        const double z = groups_[group].z, length = groups_[to].z - z;
        double least = low, greatest = std::min(high, from);
        for (std::size_t i = group + 1; i < to; ++i) {
            const double scale = length / (groups_[i].z - z);
            least = std::max(least, from + (groups_[i].low - slack_ - from) * scale);
            greatest = std::min(greatest, from + (groups_[i].high + slack_ - from) * scale);
        }
        const double value = std::min(std::max(groups_[to].before, least), greatest);
        return std::min(std::max(value, low), high);
    }

    FewestScratch& s_;
    std::vector<Group>& groups_;
    Funnel& funnel_;
    double epsilon_, start_, slack_;
    std::size_t flat_ = 0;    // the last group whose front the function may reach level
    std::size_t budget_ = 0;  // vertices in all
    std::size_t end_ = 0;     // no group from here on is reached
};

}  // namespace

std::size_t FewestScratch::bytes() const {
    return groups.capacity() * sizeof(Group) + earliest.capacity() * sizeof(std::size_t) +
           reached.capacity() * sizeof(Reached) + pieces.capacity() * sizeof(Piece) + knots.capacity() * sizeof(Knot) +
           plain.capacity() * sizeof(Vertex) + funnel.bytes();
}

std::size_t compress_to_fewest(CurveView curve, float tolerance, FewestScratch& scratch, Vertex* out) {
    if (curve.empty()) return 0;
    scratch.plain.resize(curve.size());
    const std::size_t count = compress(curve, tolerance, scratch.plain.data());
    if (count > 1) {
        Search search(curve, tolerance, scratch);
        if (search.find(count)) return search.write(out);
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
