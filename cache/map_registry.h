// cache/map_registry.h -- records which addresses belong to maps of grid files, so that a signal
// handler can look them up. Used only inside the cache room.
//
// Threads   Many threads may call all functions at once. cut_map_at() may also be called in a
//           signal handler, because it takes no lock and allocates no memory.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

namespace stormcellar::cache {

// A place in the registry, for one map. Places are reused and never freed, so that a signal handler
// may search them at any time.
struct MapPlace {
    std::atomic<bool> taken{false};
    std::atomic<std::uint32_t> changes{0};  // odd while begin and end are being changed
    std::atomic<std::uintptr_t> begin{0}, end{0};
    std::atomic<bool> cut{false};
};

// Keeps a map in the registry while this object lives. The map must outlive the object.
class MapRegistration {
  public:
    MapRegistration() = default;  // without a map
    MapRegistration(const void* start, std::size_t size);
    MapRegistration(MapRegistration&& other) noexcept
        : place_(std::exchange(other.place_, nullptr)) {}
    MapRegistration& operator=(MapRegistration&&) = delete;
    MapRegistration(const MapRegistration&) = delete;
    MapRegistration& operator=(const MapRegistration&) = delete;
    ~MapRegistration() { release(); }

    void release();
    // Returns true if cut_map_at() was called for the map since it was registered.
    [[nodiscard]] bool was_cut() const { return place_ != nullptr && place_->cut.load(); }

  private:
    MapPlace* place_ = nullptr;
};

struct MapRange {
    std::uintptr_t begin = 0, end = 0;
};
// Marks the registered map that contains the address as cut, and returns the map's range. Returns
// none if no registered map contains the address.
[[nodiscard]] std::optional<MapRange> cut_map_at(std::uintptr_t address);

}  // namespace stormcellar::cache
