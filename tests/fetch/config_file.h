// tests/fetch/config_file.h -- loads configurations that a test writes.
#pragma once

#include <fstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/testing/data.h"
#include "tests/testing/temporary_directory.h"

namespace stormcellar::testing {

// `load_config` is a service's function that reads its part of stormcellard.toml.
template <auto load_config>
class ConfigFile : public ::testing::Test {
  protected:
    auto load(const std::string& text) {
        std::ofstream(directory_ / "s.toml") << text;
        return load_config(directory_ / "s.toml");
    }
    std::string complaint(const std::string& text) {
        const auto config = load(text);
        return config ? "it was taken" : config.error().message;
    }
    static auto load_shipped() {
        return load_config(source_directory() / "daemon/stormcellard.toml");
    }
    TemporaryDirectory directory_;
};

}  // namespace stormcellar::testing
