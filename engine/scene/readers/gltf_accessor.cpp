#include "scene/readers/gltf_accessor.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "scene/limits.h"
#include "scene/readers/file_reader.h"

namespace shadowbench::scene {
namespace {

using base::Vec2f;
using base::Vec3f;

template <typename T>
T load(const char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

std::uint64_t bytes_each(GltfComponent type) {
    switch (type) {
        case GltfComponent::int8:
        case GltfComponent::uint8:
            return 1;
        case GltfComponent::int16:
        case GltfComponent::uint16:
            return 2;
        case GltfComponent::uint32:
        case GltfComponent::float32:
            return 4;
    }
    return 4;
}

// glTF 2.0, section 3.11: how whole numbers stand for fractions.
float component(const char* from, GltfComponent type, bool normalized) {
    switch (type) {
        case GltfComponent::int8: {
            const auto value = static_cast<float>(load<std::int8_t>(from));
            return normalized ? std::max(value / 127.0f, -1.0f) : value;
        }
        case GltfComponent::uint8: {
            const auto value = static_cast<float>(load<std::uint8_t>(from));
            return normalized ? value / 255.0f : value;
        }
        case GltfComponent::int16: {
            const auto value = static_cast<float>(load<std::int16_t>(from));
            return normalized ? std::max(value / 32767.0f, -1.0f) : value;
        }
        case GltfComponent::uint16: {
            const auto value = static_cast<float>(load<std::uint16_t>(from));
            return normalized ? value / 65535.0f : value;
        }
        case GltfComponent::uint32:
            return static_cast<float>(load<std::uint32_t>(from));
        case GltfComponent::float32:
            return load<float>(from);
    }
    return 0.0f;
}

std::uint32_t whole(const char* from, GltfComponent type) {
    if (type == GltfComponent::uint8) return load<std::uint8_t>(from);
    if (type == GltfComponent::uint16) return load<std::uint16_t>(from);
    return load<std::uint32_t>(from);
}

bool is_whole(GltfComponent type) {
    return type == GltfComponent::uint8 || type == GltfComponent::uint16 || type == GltfComponent::uint32;
}

// Elements of `bytes` bytes in a view; `at` is the JSON pointer of what names them.
struct Elements {
    std::size_t view = 0;
    std::uint64_t offset = 0, count = 0, bytes = 0, stride = 0;
    std::string at;
};

void check_view(const GltfModel& model, std::size_t number) {
    const GltfView& view = model.views[number];
    const std::uint64_t size = model.buffers[view.buffer].size;
    if (view.offset + view.length > size)
        fail(model, fmt::format("/bufferViews/{}", number),
             fmt::format("{} bytes from byte {} on, but the buffer has {}", view.length, view.offset, size));
}

void check_elements(const GltfModel& model, const Elements& elements) {
    check_view(model, elements.view);
    const std::uint64_t length = model.views[elements.view].length;
    const std::uint64_t most = length < elements.offset + elements.bytes
                                   ? 0
                                   : (length - elements.offset - elements.bytes) / elements.stride + 1;
    if (elements.count > most)
        fail(model, elements.at,
             fmt::format("{} elements of {} bytes, but the view {} has room for {}", elements.count, elements.bytes,
                         elements.view, most));
}

std::vector<char> read_bytes(const GltfBuffer& buffer, std::uint64_t offset, std::uint64_t count) {
    if (buffer.file.empty()) {
        const char* const begin = buffer.bytes.data() + offset;
        return {begin, begin + count};
    }
    FileReader reader(buffer.file);
    reader.seek(buffer.begin + offset, "buffer");
    return reader.array<char>(count, "buffer");
}

// Calls `take` with the number of every element and its bytes.
void each_element(const GltfModel& model, const Elements& elements,
                  const std::function<void(std::uint64_t number, const char* bytes)>& take) {
    const GltfView& view = model.views[elements.view];
    const std::uint64_t at_once = std::max<std::uint64_t>((std::uint64_t{1} << 20) / elements.stride, 1);
    for (std::uint64_t first = 0; first < elements.count; first += at_once) {
        const std::uint64_t here = std::min(at_once, elements.count - first);
        const std::vector<char> bytes =
            read_bytes(model.buffers[view.buffer], view.offset + elements.offset + first * elements.stride,
                       (here - 1) * elements.stride + elements.bytes);
        for (std::uint64_t i = 0; i < here; ++i) take(first + i, bytes.data() + i * elements.stride);
    }
}

// Those of an accessor, of which some may be replaced by its sparse part. Checked, unless they have no bytes.
Elements elements_of(const GltfModel& model, std::size_t number) {
    const GltfAccessor& accessor = model.accessors[number];
    const std::string at = fmt::format("/accessors/{}", number);
    const std::uint64_t bytes = bytes_each(accessor.type) * static_cast<std::uint64_t>(accessor.components);
    Elements elements{accessor.view.value_or(0), accessor.offset, accessor.count, bytes, bytes, at};
    if (accessor.view) {
        const std::uint64_t stride = model.views[*accessor.view].stride;
        if (stride > 0) elements.stride = stride;
        check_elements(model, elements);
    } else if (accessor.count > most_gltf_zeros) {
        fail(model, at, fmt::format("{} elements without a view; the limit is {}", accessor.count, most_gltf_zeros));
    }
    return elements;
}

// Appends the values.
template <typename Value>
void read_all(const GltfModel& model, std::size_t number, const Value& zero,
              const std::function<Value(std::uint64_t number, const char* bytes)>& convert,
              std::vector<Value>& values) {
    const GltfAccessor& accessor = model.accessors[number];
    const Elements elements = elements_of(model, number);
    const std::string& at = elements.at;
    const std::uint64_t bytes = elements.bytes;
    const std::size_t first = values.size();
    values.resize(first + static_cast<std::size_t>(accessor.count), zero);
    const auto keep = [&](std::uint64_t i, const char* from) { values[first + i] = convert(i, from); };
    if (accessor.view) each_element(model, elements, keep);
    if (!accessor.sparse) return;

    const GltfSparse& sparse = *accessor.sparse;
    if (!is_whole(sparse.indices_type)) fail(model, at + "/sparse/indices", "indices must be whole numbers");
    const std::uint64_t index_bytes = bytes_each(sparse.indices_type);
    const Elements places{sparse.indices, sparse.indices_offset, sparse.count,
                          index_bytes,    index_bytes,           at + "/sparse/indices"};
    const Elements replaced{sparse.values, sparse.values_offset, sparse.count, bytes, bytes, at + "/sparse/values"};
    check_elements(model, places);
    check_elements(model, replaced);
    std::vector<std::uint32_t> targets(static_cast<std::size_t>(sparse.count));
    each_element(model, places, [&](std::uint64_t i, const char* from) {
        targets[i] = whole(from, sparse.indices_type);
        if (targets[i] >= accessor.count)
            fail(model, places.at, fmt::format("names element {} of {}", targets[i], accessor.count));
    });
    each_element(model, replaced, [&](std::uint64_t i, const char* from) { keep(targets[i], from); });
}

template <typename Vector>
void read_vectors(const GltfModel& model, std::size_t number, double most, const char* what, std::vector<Vector>& to) {
    const GltfAccessor& accessor = model.accessors[number];
    constexpr int components = static_cast<int>(Vector::dimensions());
    const std::string at = fmt::format("/accessors/{}", number);
    if (accessor.components != components)
        fail(model, at, fmt::format("{} components; {} have {}", accessor.components, what, components));
    const std::uint64_t bytes = bytes_each(accessor.type);
    const auto convert = [&](std::uint64_t i, const char* from) {
        Vector value(0.0f);
        for (int axis = 0; axis < components; ++axis) {
            const float given =
                component(from + bytes * static_cast<std::uint64_t>(axis), accessor.type, accessor.normalized);
            if (!(std::abs(static_cast<double>(given)) <= most))
                fail(model, at, fmt::format("element {}: {} is not a finite number below {}", i, given, most));
            value[axis] = given;
        }
        return value;
    };
    read_all<Vector>(model, number, Vector(0.0f), convert, to);
}

}  // namespace

void check_gltf_accessor(const GltfModel& model, std::size_t accessor) {
    elements_of(model, accessor);
}

void add_gltf_points(const GltfModel& model, std::size_t accessor, std::vector<Vec3f>& to) {
    read_vectors<Vec3f>(model, accessor, max_coordinate, "positions", to);
}

std::vector<Vec2f> read_gltf_uvs(const GltfModel& model, std::size_t accessor) {
    std::vector<Vec2f> uvs;
    read_vectors<Vec2f>(model, accessor, max_coordinate, "texture coordinates", uvs);
    return uvs;
}

GltfIndices::GltfIndices(const GltfModel& model, std::size_t accessor) : model_(model), accessor_(accessor) {
    const GltfAccessor& indices = model.accessors[accessor];
    if (indices.components != 1 || !is_whole(indices.type))
        fail(model, fmt::format("/accessors/{}", accessor), "indices must be SCALAR, of whole numbers from 0 on");
    if (indices.count == 0) return;
    if (indices.sparse)
        read_all<std::uint32_t>(
            model, accessor, 0, [&](std::uint64_t, const char* from) { return whole(from, indices.type); }, held_);
    else
        load(0);
    first_ = held_[0];
}

std::uint32_t GltfIndices::operator[](std::uint64_t number) {
    if (number == 0) return first_;
    if (number < begin_ || number - begin_ >= held_.size()) load(number);
    return held_[static_cast<std::size_t>(number - begin_)];
}

void GltfIndices::load(std::uint64_t first) {
    constexpr std::uint64_t most_at_once = 1 << 18;
    const GltfAccessor& indices = model_.accessors[accessor_];
    Elements elements = elements_of(model_, accessor_);
    elements.offset += first * elements.stride;
    elements.count = std::min(elements.count - first, most_at_once);
    begin_ = first;
    held_.assign(static_cast<std::size_t>(elements.count), 0);
    if (indices.view)
        each_element(model_, elements,
                     [&](std::uint64_t i, const char* from) { held_[i] = whole(from, indices.type); });
}

std::vector<char> read_gltf_view(const GltfModel& model, std::size_t number) {
    check_view(model, number);
    const GltfView& view = model.views[number];
    return read_bytes(model.buffers[view.buffer], view.offset, view.length);
}

}  // namespace shadowbench::scene
