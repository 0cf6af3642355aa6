#include "cache/map_registry.h"

#include <array>

namespace stormcellar::cache {
namespace {

static_assert(std::atomic<std::uintptr_t>::is_always_lock_free);

// A block of places. When it is full, it links to the next block. The first block needs no
// allocation.
struct Block {
    std::array<MapPlace, 256> places;
    std::atomic<Block*> next{nullptr};
};

// The first block is never destroyed, because a handler may run while the program ends.
Block& first_block() {
    static constinit Block block;
    return block;
}

Block& block_after(Block& block) {
    if (Block* next = block.next.load()) return *next;
    auto* made = new Block;
    Block* nobody = nullptr;
    if (block.next.compare_exchange_strong(nobody, made)) return *made;
    delete made;  // another thread has linked a block first
    return *nobody;
}

MapPlace& free_place() {
    for (Block* block = &first_block();; block = &block_after(*block)) {
        for (MapPlace& place : block->places) {
            bool taken = false;
            if (place.taken.compare_exchange_strong(taken, true)) return place;
        }
    }
}

void set_range(MapPlace& place, std::uintptr_t begin, std::uintptr_t end) {
    ++place.changes;
    place.begin = begin;
    place.end = end;
    ++place.changes;
}

}  // namespace

MapRegistration::MapRegistration(const void* start, std::size_t size) : place_(&free_place()) {
    place_->cut = false;
    const auto begin = reinterpret_cast<std::uintptr_t>(start);
    set_range(*place_, begin, begin + size);
}

void MapRegistration::release() {
    if (place_ == nullptr) return;
    set_range(*place_, 0, 0);
    place_->taken = false;
    place_ = nullptr;
}

// Skips a place that is being changed. The map whose read failed has another place, because nobody
// changes the place of that map during the fault.
std::optional<MapRange> cut_map_at(std::uintptr_t address) {
    for (Block* block = &first_block(); block != nullptr; block = block->next.load()) {
        for (MapPlace& place : block->places) {
            const std::uint32_t changes = place.changes;
            const MapRange range{place.begin, place.end};
            const bool stable = changes % 2 == 0 && place.changes == changes;
            if (!stable || address < range.begin || address >= range.end) continue;
            place.cut = true;
            return range;
        }
    }
    return std::nullopt;
}

}  // namespace stormcellar::cache
