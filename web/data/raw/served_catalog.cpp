#include "web/data/raw/served_catalog.h"

namespace stormcellar::web {

Result<ServedCatalog::Reader> ServedCatalog::get() {
    if (directory_.empty()) return fail(ErrorCode::not_found, "no catalog is served");
    const MutexLock lock(mutex_);
    if (reader_) return reader_;
    auto opened = catalog::CatalogReader::open(directory_);
    if (!opened) return pass_on(opened);
    reader_ = std::make_shared<const catalog::CatalogReader>(std::move(*opened));
    return reader_;
}

}  // namespace stormcellar::web
