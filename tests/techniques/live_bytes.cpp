#include "techniques/live_bytes.h"

#include <atomic>
#include <cstdlib>
#include <new>

// Every block carries its size in front of it, as far in front as it is aligned.
namespace {

std::atomic<std::size_t> live{0};

void* allocate(std::size_t size, std::size_t alignment) {
    const std::size_t head = alignment < 16 ? 16 : alignment;
    const std::size_t total = (size + head + head - 1) / head * head;
    auto* block = static_cast<char*>(std::aligned_alloc(head, total));
    if (!block) throw std::bad_alloc();
    live += size;
    *reinterpret_cast<std::size_t*>(block + head - 16) = size;
    *reinterpret_cast<std::size_t*>(block + head - 8) = head;
    return block + head;
}

void release(void* pointer) noexcept {
    if (!pointer) return;
    auto* p = static_cast<char*>(pointer);
    live -= *reinterpret_cast<std::size_t*>(p - 16);
    std::free(p - *reinterpret_cast<std::size_t*>(p - 8));
}

}  // namespace

void* operator new(std::size_t size) {
    return allocate(size, 16);
}
void* operator new[](std::size_t size) {
    return allocate(size, 16);
}
void* operator new(std::size_t size, std::align_val_t a) {
    return allocate(size, static_cast<std::size_t>(a));
}
void* operator new[](std::size_t size, std::align_val_t a) {
    return allocate(size, static_cast<std::size_t>(a));
}
void operator delete(void* p) noexcept {
    release(p);
}
void operator delete[](void* p) noexcept {
    release(p);
}
void operator delete(void* p, std::size_t) noexcept {
    release(p);
}
void operator delete[](void* p, std::size_t) noexcept {
    release(p);
}
void operator delete(void* p, std::align_val_t) noexcept {
    release(p);
}
void operator delete[](void* p, std::align_val_t) noexcept {
    release(p);
}
void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
    release(p);
}
void operator delete[](void* p, std::size_t, std::align_val_t) noexcept {
    release(p);
}

namespace shadowbench::techniques::testing {

std::size_t live_bytes() {
    return live;
}

}  // namespace shadowbench::techniques::testing
