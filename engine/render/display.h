// What a display shows of linear values.
#pragma once

namespace shadowbench::render {

// sRGB's transfer function, IEC 61966-2-1: linear [0, 1] to display [0, 1].
double to_display(double linear);
double from_display(double shown);  // its inverse

}  // namespace shadowbench::render
