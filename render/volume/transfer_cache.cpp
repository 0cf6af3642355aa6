#include "render/volume/transfer_cache.h"

namespace stormcellar::render {

std::shared_ptr<const TransferFunction> TransferCache::get(const ColorTable& table,
                                                           const grid::Quantization& quantization,
                                                           double opacity, double step_m,
                                                           Integration integration, int threads) {
    Key key{table, quantization, opacity, step_m, integration};
    if (key_ != key) {
        made_ = std::make_shared<const TransferFunction>(table, quantization, opacity, step_m,
                                                         integration, threads);
        key_ = std::move(key);
        ++times_made_;
    }
    return made_;
}

}  // namespace stormcellar::render
