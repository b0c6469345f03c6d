#include "curves/fewest_trace.h"

#include <algorithm>

namespace shadowbench::curves::fewest {

namespace {

// A segment that ends in front of a given group.
struct Link {
    std::size_t group;  // behind which it starts; none: there is no such segment
    double from, to;    // its values
};

class Trace {
public:
    Trace(FewestScratch& scratch, const Problem& problem)
        : s_(scratch), problem_(problem), slack_(problem.slack), back_(scratch.funnel) {}

    bool run(std::size_t vertices, const Knot& last) {
        s_.knots.assign(1, last);
        while (vertices > 1) {
            const Knot to = s_.knots.back();
            const Group& group = s_.groups[to.group];
            Link link{none, 0.0, 0.0};
            if (group.low <= to.value && to.value <= group.high)
                link = link_to(to.group, to.value, to.value, vertices - 1);
            if (link.group != none) {
                --vertices;
            } else if (!has_step(group)) {
                return false;
            } else if (vertices == 2) {  // the first vertex, and a step
                if (to.group > problem_.flat) return false;
                s_.knots.push_back({to.group, problem_.start});
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

private:
    // A segment to [low, high] in front of a group from what is reached with so many vertices. Of the values at its
    // ends it takes those nearest to the input. Windows are wider here by another slack, so that a segment that the
    // search has found is found again.
    Link link_to(std::size_t to, double low, double high, std::size_t vertices) {
        back_.start(s_.groups[to].z, low, high);
        for (std::size_t group = to; group-- > earliest(s_, problem_.budget - vertices);) {
            const Group& at = s_.groups[group];
            const double least = back_.lowest(at.z), greatest = back_.highest(at.z);
            for (std::size_t piece = first_piece(s_, vertices, group); piece != none; piece = s_.pieces[piece].next) {
                const double lowest = std::max(least, s_.pieces[piece].low);
                const double highest = std::min(greatest, s_.pieces[piece].high);
                if (!(lowest <= highest)) continue;
                const double from = std::min(std::max(at.after, lowest), highest);
                return {group, from, end_of(group, from, to, low, high)};
            }
            if (!back_.meets(at.z, at.low - slack_, at.high + slack_)) break;
            back_.pass(at.z, at.low - slack_, at.high + slack_);
        }
        return {none, 0.0, 0.0};
    }

    // Where in [low, high] a segment from this value ends.
    double end_of(std::size_t group, double from, std::size_t to, double low, double high) const {
        const Group& start = s_.groups[group];
        const double length = s_.groups[to].z - start.z, aim = s_.groups[to].before;
        double least = low, greatest = std::min(high, from);
        for (std::size_t i = group + 1; i < to; ++i) {
            const Group& passed = s_.groups[i];
            const double scale = length / (passed.z - start.z);
            least = std::max(least, from + (passed.low - slack_ - from) * scale);
            greatest = std::min(greatest, from + (passed.high + slack_ - from) * scale);
        }
        // From an end of what leads there, one line leads there, and rounding may leave none. The windows on which it
        // leans far ahead then tell where it ends: the lower ones from the greatest value, and the upper ones from the
        // least.
        const double value = from < start.after ? std::max(std::min(aim, greatest), least)
                                                : std::min(std::max(aim, least), greatest);
        return std::min(std::max(value, low), high);
    }

    FewestScratch& s_;
    const Problem& problem_;
    double slack_;
    BackwardFunnel back_;
};

}  // namespace

bool trace(FewestScratch& s, const Problem& problem, std::size_t vertices, const Knot& last) {
    return Trace(s, problem).run(vertices, last);
}

}  // namespace shadowbench::curves::fewest
