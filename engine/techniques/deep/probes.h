// Anisotropic filtering (Lokovic and Veach 2000, section 5.3): a lookup over a parallelogram as several narrow lookups
// along its long axis, as texture filters do.
#pragma once

#include "techniques/technique.h"

namespace shadowbench::techniques {

// Lookups of one width, side by side on a line through the query.
struct Probes {
    int count = 1;
    float width = 0.0f;                  // of each, map pixels
    float step_x = 0.0f, step_y = 0.0f;  // from one to the next, map pixels

    Query at(const Query& q, int number) const {
        const float steps = static_cast<float>(number) - 0.5f * static_cast<float>(count - 1);
        return {q.x + steps * step_x, q.y + steps * step_y, q.z, width};
    }
};

// The probes of a footprint, at most `most` (at least 1). Returns false if the footprint is not known or not finite.
//
// The parallelogram is the image of a square under the matrix whose columns are its edges. Its axes are those of that
// matrix: the singular values a >= b are their lengths, and the long one has the direction of the left singular vector
// of a. There are N = ceil(a / b) probes, or `most` if that is fewer, each max(b, a / N) wide, so that they leave no
// gaps. Together they have the second moments of the parallelogram, a^2 / 12 along the long axis: their distance is
// sqrt((a^2 - width^2) / (N^2 - 1)). No probe is narrower than a pixel of the map unless the parallelogram's long axis
// is: a map has nothing finer. One probe is a square as wide as the long axis.
bool probes_of(const Footprint& footprint, int most, Probes& out);

// Calls visit(probe) for the probes whose centres are inside the map; if none is, for one at the query.
template <class Inside, class Visit>
void for_each_probe(const Query& q, const Probes& probes, const Inside& inside, const Visit& visit) {
    bool any = false;
    for (int number = 0; number < probes.count; ++number) {
        const Query probe = probes.at(q, number);
        if (!inside(probe)) continue;
        any = true;
        visit(probe);
    }
    if (!any) visit(Query{q.x, q.y, q.z, probes.width});
}

}  // namespace shadowbench::techniques
