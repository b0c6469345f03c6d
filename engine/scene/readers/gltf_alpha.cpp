#include "scene/readers/gltf_alpha.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/gltf_image.h"
#include "scene/readers/read_mesh.h"

namespace shadowbench::scene {
namespace {

// A part of the mesh's texture, with a texel more on each side than its triangles reach.
struct Part {
    double constant = 1.0;              // the opacity of a part without an image
    std::optional<AlphaTexture> image;  // opacities
    GltfWrap wrap_u = GltfWrap::repeat, wrap_v = GltfWrap::repeat;
    std::uint32_t material = no_material;
    Vec2d low{0, 0}, high{0, 0};  // the texture coordinates that triangles reach
    bool reached = false;
    std::int64_t first_column = 0, first_row = 0;  // the texel of the image at the part's corner
    int width = 3, height = 3;
    int column = 0, row = 0;  // of the part's corner in the mesh's texture
};

double opacity(const GltfMaterial& material, double alpha) {
    const double value = std::clamp(alpha * material.factor, 0.0, 1.0);
    if (material.mode == GltfAlphaMode::mask) return value >= material.cutoff ? 1.0 : 0.0;
    return value;
}

double period(GltfWrap wrap) {
    return wrap == GltfWrap::repeat ? 1.0 : wrap == GltfWrap::mirror ? 2.0 : 0.0;
}

std::size_t wrapped(std::int64_t texel, int count, GltfWrap wrap) {
    const std::int64_t all = count;
    if (wrap == GltfWrap::clamp) return static_cast<std::size_t>(std::clamp<std::int64_t>(texel, 0, all - 1));
    const std::int64_t cycle = wrap == GltfWrap::repeat ? all : 2 * all;
    const std::int64_t within = ((texel % cycle) + cycle) % cycle;
    return static_cast<std::size_t>(within < all ? within : cycle - 1 - within);
}

class AlphaAtlas {
public:
    AlphaAtlas(const GltfModel& model, const std::vector<std::uint32_t>& materials, MeshFile& file)
        : model_(model), materials_(materials), file_(file) {}

    void add() {
        find_parts();
        images_.clear();
        if (parts_.size() == 1 && !parts_[0].image && parts_[0].constant == 1.0) parts_.clear();
        if (parts_.empty()) {
            for (Vec2f& uv : file_.mesh.corner_uv) uv.y = 1.0f - uv.y;
            return;
        }
        find_reach();
        pack();
        fill();
        place_corners();
    }

private:
    void find_parts() {
        std::map<std::uint32_t, std::uint32_t> by_material;
        part_of_triangle_.reserve(materials_.size());
        for (std::size_t triangle = 0; triangle < materials_.size(); ++triangle) {
            const std::uint32_t material = materials_[triangle];
            // Neighbours mostly have one material.
            if (triangle > 0 && material == materials_[triangle - 1]) {
                part_of_triangle_.push_back(part_of_triangle_.back());
                continue;
            }
            const auto [known, added] = by_material.try_emplace(material, std::uint32_t{0});
            if (added) known->second = part_of(material);
            part_of_triangle_.push_back(known->second);
        }
    }

    std::uint32_t part_of(std::uint32_t material) {
        Part part;
        if (material != no_material && model_.materials[material].mode != GltfAlphaMode::opaque)
            part = part_for(material);
        const auto next = static_cast<std::uint32_t>(parts_.size());
        if (!part.image) {
            const auto [known, added] = by_constant_.try_emplace(part.constant, next);
            if (!added) return known->second;
        }
        parts_.push_back(std::move(part));
        return next;
    }

    Part part_for(std::uint32_t number) {
        const GltfMaterial& material = model_.materials[number];
        Part part;
        part.material = number;
        part.constant = opacity(material, 1.0);
        if (!material.texture) return part;
        const GltfTexture& texture = model_.textures[*material.texture];
        if (!texture.image) {
            pass_over(file_, "alpha textures of formats that are not read");
            return part;
        }
        const std::optional<AlphaTexture>& original = image_of(*texture.image);
        if (!original) return part;
        check_texels(original->alpha.size());
        std::optional<AlphaTexture> image = original;
        for (float& texel : image->alpha) texel = static_cast<float>(opacity(material, static_cast<double>(texel)));
        const float first = image->alpha.front();
        if (std::all_of(image->alpha.begin(), image->alpha.end(), [&](float texel) { return texel == first; })) {
            part.constant = static_cast<double>(first);
            return part;
        }
        if (material.uv_turned)
            fail(model_, place(number),
                 "it turns its alpha texture (rotation of KHR_texture_transform), which is not read: write the file "
                 "with the texture coordinates turned");
        part.image = std::move(image);
        part.wrap_u = texture.u;
        part.wrap_v = texture.v;
        return part;
    }

    // Each image is read once, however many materials name it.
    const std::optional<AlphaTexture>& image_of(std::size_t number) {
        const auto [known, added] = images_.try_emplace(number);
        if (added) {
            check_bytes(number);
            known->second = read_gltf_image(model_, number);
        }
        return known->second;
    }

    // Many images of a small file may lie in the same bytes of it.
    void check_bytes(std::size_t number) {
        const std::optional<std::size_t> view = model_.images[number].view;
        if (!view) return;
        bytes_ += model_.views[*view].length;
        if (bytes_ > most_gltf_image_bytes)
            fail(model_, fmt::format("/images/{}", number),
                 fmt::format("the images up to here have {} bytes; the limit is {}", bytes_, most_gltf_image_bytes));
    }

    // Refuses images, before they fill the memory.
    void check_texels(std::uint64_t more) {
        texels_ += more;
        if (texels_ > most_gltf_texels)
            fail(model_, "/materials",
                 fmt::format("their alpha textures have {} texels or more; the limit is {}: use smaller ones", texels_,
                             most_gltf_texels));
    }

    static std::string place(std::uint32_t material) { return fmt::format("/materials/{}", material); }

    // Moves each triangle by whole repetitions of its texture, next to (0, 0).
    void find_reach() {
        std::vector<Vec2f>& uvs = file_.mesh.corner_uv;
        for (std::size_t triangle = 0; triangle < part_of_triangle_.size(); ++triangle) {
            Part& part = parts_[part_of_triangle_[triangle]];
            if (!part.image) continue;
            const GltfMaterial& material = model_.materials[part.material];
            Vec2d at[3];
            for (std::size_t corner = 0; corner < 3; ++corner)
                at[corner] = Vec2d(uvs[3 * triangle + corner]) * material.uv_scale + material.uv_offset;
            Vec2d move(0, 0);
            for (int axis = 0; axis < 2; ++axis) {
                const double cycle = period(axis == 0 ? part.wrap_u : part.wrap_v);
                if (cycle > 0.0)
                    move[axis] = std::floor(std::min({at[0][axis], at[1][axis], at[2][axis]}) / cycle) * cycle;
            }
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const Vec2f moved(at[corner] - move);
                uvs[3 * triangle + corner] = moved;
                reach(part, Vec2d(moved));
            }
        }
    }

    static void reach(Part& part, const Vec2d& at) {
        if (!part.reached) part.low = part.high = at;
        part.reached = true;
        for (int axis = 0; axis < 2; ++axis) {
            part.low[axis] = std::min(part.low[axis], at[axis]);
            part.high[axis] = std::max(part.high[axis], at[axis]);
        }
    }

    // Sets the first texel and the number of texels along an axis.
    void measure(const Part& part, double low, double high, int texels, std::int64_t& first, int& count) const {
        // Interpolation reads the texel whose centre lies below, and the next one.
        const double from = std::floor(low * texels - 0.5) - 1.0, to = std::floor(high * texels - 0.5) + 2.0;
        if (!(to - from < max_image_side) || !(std::abs(from) < 1e15))
            fail(model_, place(part.material),
                 fmt::format("a triangle reaches over {:.0f} texels of its alpha texture; the limit is {}: repeat the "
                             "texture less often, or use a smaller one",
                             to - from, max_image_side));
        first = static_cast<std::int64_t>(from);
        count = static_cast<int>(to - from) + 1;
    }

    // Places the parts in rows, the highest first.
    void pack() {
        double area = 0.0;
        int widest = 0;
        std::vector<std::size_t> order;
        for (Part& part : parts_) {
            if (part.image) {
                measure(part, part.low.x, part.high.x, part.image->width, part.first_column, part.width);
                measure(part, part.low.y, part.high.y, part.image->height, part.first_row, part.height);
            }
            area += static_cast<double>(part.width) * part.height;
            widest = std::max(widest, part.width);
            order.push_back(order.size());
        }
        std::stable_sort(order.begin(), order.end(),
                         [&](std::size_t a, std::size_t b) { return parts_[a].height > parts_[b].height; });
        const double most = static_cast<double>(most_gltf_texels);
        width_ = std::max(widest, static_cast<int>(std::sqrt(std::min(area, most))));
        double top = 0.0, below = 0.0;
        int left = width_;
        for (const std::size_t number : order) {
            Part& part = parts_[number];
            if (left + part.width > width_) {
                top = below;
                below += part.height;
                left = 0;
                if (below * width_ > most)
                    fail(model_, "/materials",
                         fmt::format("their alpha textures, as often as they repeat, need over {} texels: use smaller "
                                     "ones",
                                     most_gltf_texels));
            }
            part.column = left;
            part.row = static_cast<int>(top);
            left += part.width;
        }
        height_ = static_cast<int>(below);
    }

    void fill() {
        auto texture = std::make_shared<AlphaTexture>();
        texture->width = width_;
        texture->height = height_;
        const auto columns = static_cast<std::size_t>(width_);
        texture->alpha.assign(columns * static_cast<std::size_t>(height_), 1.0f);
        for (const Part& part : parts_)
            for (int y = 0; y < part.height; ++y)
                for (int x = 0; x < part.width; ++x)
                    texture->alpha[static_cast<std::size_t>(part.row + y) * columns +
                                   static_cast<std::size_t>(part.column + x)] = texel(part, x, y);
        file_.mesh.alpha = std::move(texture);
    }

    static float texel(const Part& part, int x, int y) {
        if (!part.image) return static_cast<float>(part.constant);
        const AlphaTexture& image = *part.image;
        const std::size_t column = wrapped(part.first_column + x, image.width, part.wrap_u),
                          row = wrapped(part.first_row + y, image.height, part.wrap_v);
        return image.alpha[row * static_cast<std::size_t>(image.width) + column];
    }

    void place_corners() {
        std::vector<Vec2f>& uvs = file_.mesh.corner_uv;
        for (std::size_t corner = 0; corner < uvs.size(); ++corner) {
            const Part& part = parts_[part_of_triangle_[corner / 3]];
            // In texels, from the part's corner on: the middle of a part without an image.
            Vec2d at(1.5, 1.5);
            if (part.image)
                at = Vec2d(
                    uvs[corner].x * static_cast<double>(part.image->width) - static_cast<double>(part.first_column),
                    uvs[corner].y * static_cast<double>(part.image->height) - static_cast<double>(part.first_row));
            uvs[corner] = Vec2f(static_cast<float>((part.column + at.x) / width_),
                                static_cast<float>(1.0 - (part.row + at.y) / height_));
        }
    }

    const GltfModel& model_;
    const std::vector<std::uint32_t>& materials_;
    MeshFile& file_;
    std::vector<Part> parts_;
    std::vector<std::uint32_t> part_of_triangle_;
    std::map<double, std::uint32_t> by_constant_;
    std::map<std::size_t, std::optional<AlphaTexture>> images_;  // without a texture: opaque ones
    std::uint64_t texels_ = 0, bytes_ = 0;
    int width_ = 0, height_ = 0;  // of the mesh's texture
};

}  // namespace

void add_gltf_alpha(const GltfModel& model, const std::vector<std::uint32_t>& materials, MeshFile& file) {
    AlphaAtlas(model, materials, file).add();
}

}  // namespace shadowbench::scene
