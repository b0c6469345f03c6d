// Stands in the program for the engine's files that need OpenImageIO: the linker takes these functions and leaves
// theirs.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include "base/error.h"
#include "render/colour_map.h"
#include "render/deep_exr.h"
#include "render/image_file.h"
#include "service/images/images.h"

namespace shadowbench::service {
namespace {

namespace fs = std::filesystem;

constexpr const char* held = "SHADOWBENCH_IMAGES_LIBRARY";  // set for children by hold_images()

[[noreturn]] void fail(const fs::path& file, std::string cause) {
    // The messages of the system name the file that the error's place names already.
    if (const std::string name = file.string() + ": "; cause.starts_with(name)) cause.erase(0, name.size());
    const bool served = std::getenv(held) != nullptr;  // clients do not learn the server's folders
    throw base::Error(base::ErrorCode::io, served ? SHADOWBENCH_IMAGES_NAME : file.string(),
                      "cannot open the library for images: " + cause);
}

// "0.2.0 0123456789ab 2049:77 /proc/1234/fd/5": the build, and which file it is. A launcher starts jobs by the name of
// the program, which may be another build by then, or on another machine, where that name may be any file. Empty for
// what cannot be read.
std::string note_of(const std::string& name) {
    struct stat file;
    if (::stat(name.c_str(), &file) != 0) return "";
    const results::Program program = results::this_program();
    return program.version + " " + program.commit + " " + std::to_string(file.st_dev) + ":" +
           std::to_string(file.st_ino) + " " + name;
}

const Images& open_images() {
    const fs::path file = images_library();
    // It is never closed: libraries behind it do not bear that.
    void* const library = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) fail(file, ::dlerror());
    void* const symbol = ::dlsym(library, images_symbol);
    if (symbol == nullptr) fail(file, ::dlerror());
    const Images& images = *reinterpret_cast<ImagesOf*>(symbol)();
    const results::Program program = results::this_program();
    if (images.build.version != program.version || images.build.commit != program.commit)
        fail(file, "it is of build " + images.build.version + " " + images.build.commit + ", this program of " +
                       program.version + " " + program.commit + "; install both together, and start servers again");
    return images;
}

const Images& images() {
    static const Images& opened = open_images();
    return opened;
}

}  // namespace

fs::path images_library() {
    if (const char* value = std::getenv(held)) {
        const std::string_view note = value;
        const std::string name(note.substr(note.rfind(' ') + 1));
        if (!note.empty() && note_of(name) == note) return name;
    }
    std::error_code failed;
    const fs::path folder = fs::read_symlink("/proc/self/exe", failed).parent_path();
    const fs::path beside = folder / SHADOWBENCH_IMAGES_NAME;
    if (fs::exists(beside, failed)) return beside;
    return (folder / SHADOWBENCH_IMAGES_FROM_PROGRAM / SHADOWBENCH_IMAGES_NAME).lexically_normal();
}

void hold_images() {
    const int file = ::open(images_library().c_str(), O_RDONLY | O_CLOEXEC);
    // Where there is none, the note of a name that does not exist is empty.
    const std::string name = "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(file);
    ::setenv(held, note_of(name).c_str(), 1);
}

}  // namespace shadowbench::service

namespace shadowbench::scene {

bool is_deep_image(const std::filesystem::path& file) {
    return service::images().is_deep_image(file);
}

DeepImage read_deep_image(const std::filesystem::path& file, const DeepChoice& choice) {
    return service::images().read_deep_image(file, choice);
}

AlphaTexture read_alpha(const std::filesystem::path& file) {
    return service::images().read_alpha(file);
}

std::optional<AlphaTexture> read_alpha_channel(const std::filesystem::path& file) {
    return service::images().read_alpha_channel(file);
}

}  // namespace shadowbench::scene

namespace shadowbench::render {

std::string encode_exr(const Image& image) {
    return service::images().encode_exr(image);
}

std::string encode_png(const Image& image) {
    return service::images().encode_png(image);
}

std::vector<base::Vec3f> colour_map(const std::vector<float>& values, int width, int height) {
    return service::images().colour_map(values, width, height);
}

void write_deep_exr(const std::filesystem::path& file, int width, int height, std::span<const DeepBlock> blocks,
                    const std::string& text) {
    service::images().write_deep_exr(file, width, height, blocks, text);
}

}  // namespace shadowbench::render
