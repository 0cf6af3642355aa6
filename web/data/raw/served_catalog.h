// web/data/raw/served_catalog.h -- the catalog that is served. It may appear after the server has
// started.
//
// Threads   Many threads may use one object.
// Errors    See get().
#pragma once

#include <filesystem>
#include <memory>
#include <utility>

#include "stormcellar/base/mutex.h"
#include "stormcellar/base/result.h"
#include "stormcellar/catalog/catalog.h"

namespace stormcellar::web {

class ServedCatalog {
  public:
    using Reader = std::shared_ptr<const catalog::CatalogReader>;

    // `reader` reads this catalog, if it is already open.
    explicit ServedCatalog(std::filesystem::path directory, Reader reader = nullptr)
        : directory_(std::move(directory)), reader_(std::move(reader)) {}

    // Returns the catalog, and opens it at the first call. Errors: not_found if none is served;
    // those of CatalogReader::open().
    [[nodiscard]] Result<Reader> get();

  private:
    const std::filesystem::path directory_;
    Mutex mutex_;
    Reader reader_ STORMCELLAR_GUARDED_BY(mutex_);
};

}  // namespace stormcellar::web
