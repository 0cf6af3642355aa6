// render/volume/transfer_cache.h -- keeps the transfer function of the last picture.
//
// The function takes milliseconds to make, and all frames of a loop have the same function.
//
// Threads   One thread at a time.
#pragma once

#include <memory>
#include <optional>

#include "render/volume/transfer_function.h"

namespace stormcellar::render {

class TransferCache {
  public:
    // Returns the function. Makes a new one if any argument but `threads` differs from the last
    // call.
    [[nodiscard]] std::shared_ptr<const TransferFunction> get(
        const ColorTable& table, const grid::Quantization& quantization, double opacity,
        double step_m, Integration integration, int threads = 1);
    [[nodiscard]] int times_made() const { return times_made_; }

  private:
    struct Key {
        ColorTable table;
        grid::Quantization quantization;
        double opacity = 0, step_m = 0;
        Integration integration{};
        bool operator==(const Key&) const = default;
    };
    std::optional<Key> key_;
    std::shared_ptr<const TransferFunction> made_;
    int times_made_ = 0;
};

}  // namespace stormcellar::render
