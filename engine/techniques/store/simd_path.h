// The instructions that loops over blocks of lookups use.
#pragma once

#include "base/simd_path.h"

namespace shadowbench::techniques {

using base::on_simd_path;
using base::set_simd_path;
using base::simd_path;
using base::simd_paths;
using base::SimdPath;

}  // namespace shadowbench::techniques
