#include "tests/level2/grow_dropping.h"

#include <algorithm>
#include <map>
#include <random>

#include "stormcellar/level2/growing_volume.h"

namespace stormcellar::level2 {

Result<Decoded> grow_dropping(std::span<const std::byte> bytes, std::size_t most, unsigned seed) {
    std::mt19937 random{seed};
    GrowingVolume volume;
    std::map<std::size_t, Sweep> outside;
    std::size_t dropped = 0;
    volume.set_dropped_sweeps(
        [&](std::size_t index) -> Result<Sweep> { return outside.at(index); });
    for (std::size_t at = 0; at < bytes.size();) {
        const std::size_t length = std::min(bytes.size() - at, 1 + random() % most);
        if (Status taken = volume.append(bytes.subspan(at, length)); !taken) break;
        at += length;
        for (LiveSweep& live : volume.take_sweeps()) {
            outside.insert_or_assign(live.index, std::move(live.sweep));
            if (live.index < dropped) volume.drop_sweep(live.index);
        }
        for (; dropped < volume.droppable_sweeps(); ++dropped)
            volume.drop_sweep(dropped);
    }
    for (std::size_t index = 0; index < dropped; ++index)
        volume.put_back(index, outside.at(index));
    return volume.finish();
}

}  // namespace stormcellar::level2
