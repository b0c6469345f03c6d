#include "claims/former.h"

#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/error.h"
#include "base/markdown.h"

namespace shadowbench::claims {
namespace {

constexpr const char* alike =
    "The pictures are compared with each other, as the paper does, and no longer by their errors; as means over the phases of the cells, and under five lights.";
constexpr const char* table_1 =
    "A GPU's times against a processor's are not judged any more. The number is of another scene: its columns lie farther apart than in the first report's, and their smoke is thinner.";

constexpr Former rows[] = {
    {"reeves1987", "section 5, table 2", "Bike store: bounding box 0.70",
     "holds in shape", "0.85", "Bike store (a room full of things): the bounding box scheme",
     "The bicycle store is not public; a stand-in cannot test its sizes."},
    {"lokovic2000", "section 6, figure 6", "1.9 times slower than the 512 map",
     "holds in shape", "3.14 [3.1, 3.28]", "deep map lookups take 37 s where the 512 map",
     "The scene has the ground and hair as fine as the paper says, and the deep map's filter weighs what the footprint covers. The figure's numbers of pixels and samples cannot both be: the readings of them disagree."},
    {"lokovic2000", "section 6, figure 6", "quality slightly better than the 4096 map",
     "does not hold here", "0.0282 against 0.021", "quality slightly better than the 4096 map",
     "Most of the error came from a filter wider than the truth's. The 400 samples are now drawn from the region's depths, as printed, and errors have intervals over seeds. The readings of the figure's numbers disagree."},
    {"lokovic2000", "section 4", "vertices a pixel grow as N^(1/4)",
     "holds in shape", "N^0.398", "vertices a pixel grow as N^(1/4)",
     "The former scene had hair in all pixels that held anything. Now 40 % hold hair and the rest simple geometry, as the paper says, and N reaches 1,024."},
    {"lokovic2000", "section 6, figure 9", "depth map filtering time grows with width",
     "holds in shape", "2.11 [1.24, 4.19]", "depth map filtering time grows rapidly",
     "The whole interval is judged now, and the rule of growth asks for a factor of 2."},
    {"lokovic2000", "section 5.3", "mip levels are 1.55 times the base",
     "holds in shape", "1.31", "all mip levels together are about 1.55",
     "In shape reached 60 % off; now it begins where holds does, at 1.41, since the middle between the paper's value and 4/3 lies above that: 1.31 would miss it, too. The number is of another scene and of the paper's own compression. Level 1 averages functions that are compressed already; levels made from the uncompressed functions stand beside it."},
    {"lokovic2000", "section 5.2", "three channels are twice as large as one",
     "holds in shape", "2.33", "three-channel maps are only twice",
     "The rule of sizes is two-sided now, and nearer to the paper's value."},
    {"pagot2004", "section 5, figure 6", "3-SM 3 x 3 looks like 1-SM 4 x 4",
     "holds in shape", "rms 0.0185 against 0.0159", "3-SM with 3 x 3 looks like",
     alike},
    {"pagot2004", "section 5, figure 7", "2-SM 3 x 3 looks like 1-SM 4 x 4",
     "does not hold here", "rms 0.0472 against 0.0205", "2-SM with 3 x 3 looks like",
     alike},
    {"pagot2004", "section 5, figure 7", "3-SM 3 x 3 looks like 1-SM 4 x 4",
     "holds in shape", "rms 0.0234 against 0.0205", "3-SM with 3 x 3 looks like",
     alike},
    {"pagot2004", "section 6", "2-SM pays beyond 1.29 fragments a cell",
     "holds in shape", "3.16 [2.64, 5.93]", "2-SM with 3 x 3 beats",
     "The paper counts samples, of which the point follows by arithmetic, and leaves times to future work. A thread's times stand beside it, and are not judged any more."},
    {"volume", "section Results", "180 to 330 frames a second",
     "does not hold here", "1.5 to 3.3", "180 to 330 frames",
     "A GPU's times against a processor's are not judged any more. A frame now has both of the paper's passes over the volume; then it had one lookup for each sample."},
    {"volume", "section Implementation", "the step before a crossing is less accurate, mostly unnoticed",
     "holds in shape", "0.0438 / 0.0434 and others", "recording the step before a crossing",
     "The first half is judged in all data sets, by lookups and by the depths that the maps store; the second in most, by lookups and by the average opacities of view rays, which are what is seen. The readings of each half must agree. All are measured over seeds of jittered light rays."},
    {"volume", "section Implementation", "and it is faster",
     "does not hold here", "0.977 to 0.993", "and it is faster",
     "Judged by whole intervals, in all data sets, in more rounds."},
    {"volume", "section Implementation", "three depths stand for the whole function",
     "holds in shape", "rms 0.044 to 0.087", "the depths of 10, 50 and 90 %",
     "The paper states no accuracy; its numbers are given beside AVSM of 2 and 4 nodes, and nothing is judged."},
    {"salvi2010", "section 5.3, table 1", "AVSM 4 looks up in 0.56 of AVSM 8's time",
     "holds in shape", "0.96", "AVSM 4 looks up in",
     table_1},
    {"salvi2010", "section 5.3, table 1", "AVSM 16 looks up in 1.8 times",
     "holds in shape", "1.09", "AVSM 16 looks up in",
     table_1},
    {"salvi2010", "section 5.3, table 1", "AVSM 16 builds in 2.3 times",
     "holds in shape", "1.52", "AVSM 16 builds in",
     table_1},
    {"salvi2010", "section 5.3, table 1", "OSM 32 looks up in 0.26 of the time",
     "holds in shape", "0.827", "OSM 32 looks up in",
     table_1},
    {"salvi2010", "section 5.3, table 1", "OSM 32 builds in 1.4 times",
     "does not hold here", "0.192", "OSM 32 builds in",
     table_1},
    {"salvi2010", "section 5.3, table 1", "DSM 0.01 looks up in 9.6 times",
     "holds in shape", "1.26", "DSM 0.01 looks up in",
     table_1},
    {"salvi2010", "section 5.3, table 1", "DSM 0.01 builds in 280 times",
     "holds in shape", "1.56", "DSM 0.01 builds in",
     table_1},
    {"salvi2010", "section 5.3, table 1", "uncompressed looks up in 51 times",
     "holds in shape", "11", "uncompressed looks up in",
     table_1},
    {"salvi2010", "section 5.1, figure 4", "AVSM 8 is much closer than OSM 32 and FOM 16",
     "does not hold here", "0.0219 against 0.0215 and 0.00751", "AVSM 8 matches the uncompressed picture",
     "Curves of one arrangement were judged; now pictures are, as in the figure. The columns' spacing and density "
     "are estimated from figure 7. The verdict depends on both, so it stands only where all readings agree."},
    {"salvi2010", "section 5.2", "4, 8 and 12 nodes",
     "holds in shape", "0.0672, 0.0184, 0.00894", "curves of 4 nodes show",
     "Judged on curves of several texels, as section 5.2 does, and no longer on lookups."},
    {"salvi2010", "section 4.1", "with 8 nodes, errors from not sorting are imperceptible",
     "holds in shape", "0.0184, 0.0249, 0.0312", "with 8 nodes, artifacts of an order",
     "Two pictures of different orders are compared with each other, as the paper says, over the whole picture and at 99 % of its pixels."},
    {"salvi2010", "section 5", "AVSM is one to two orders of magnitude faster than DSM",
     "holds in shape", "1.56 and 1.26", "AVSM is one to two orders",
     "In shape has a lower limit now: a third of the gain. AVSM has 12 nodes, as in figures 3 and 6; the first report's had 8."},
};

const Claim& claim_now(const PaperReport& report, const Former& former) {
    const Claim* found = nullptr;
    for (const Claim& claim : report.claims) {
        if (!claim.place.starts_with(former.place) || !claim.says.starts_with(former.now)) continue;
        if (found)
            throw base::Error(base::ErrorCode::internal, report.id,
                              fmt::format("two claims of {} begin with \"{}\"", former.place, former.now));
        found = &claim;
    }
    if (!found)
        throw base::Error(base::ErrorCode::internal, report.id, fmt::format("no claim of {} begins with \"{}\"", former.place, former.now));
    return *found;
}

}  // namespace

std::span<const Former> former_verdicts() {
    return rows;
}

std::string former_table(std::span<const PaperReport> reports) {
    std::vector<std::vector<std::string>> cells;
    for (const PaperReport& report : reports)
        for (const Former& former : rows) {
            if (report.id != former.paper) continue;
            const Claim& claim = claim_now(report, former);
            cells.push_back({fmt::format("{}, {}", former.paper, former.place), former.claim, fmt::format("{}: {}", former.verdict, former.measured),
                             fmt::format("{}: {}", to_string(claim.judged.verdict), claim.measured), former.why});
        }
    if (cells.empty()) return "";
    return base::markdown_table({"where", "claim", "2026-11-23", "now", "what is different"}, cells);
}

}  // namespace shadowbench::claims
