# Finds every package that the project uses. docs/dependencies.md says why each is used. A room links only
# the targets that it needs, so a program loads only the libraries that it uses.
#
# The installed CMake package reads this file, too. It sets STORMCELLAR_WANTED to the targets that the chosen
# components need; packages of other targets are then not searched for (stormcellarConfig.cmake.in).

# stormcellar_package(TARGET COMMAND ARGUMENTS...): runs the command, which finds the package of the target.
macro(stormcellar_package target command)
  if(NOT DEFINED STORMCELLAR_WANTED OR "${target}" IN_LIST STORMCELLAR_WANTED)
    cmake_language(CALL ${command} ${ARGN})
  endif()
endmacro()

find_package(PkgConfig REQUIRED)
stormcellar_package(Threads::Threads find_package Threads REQUIRED)
stormcellar_package(BZip2::BZip2 find_package BZip2 REQUIRED)
stormcellar_package(ZLIB::ZLIB find_package ZLIB REQUIRED)
stormcellar_package(PNG::PNG find_package PNG REQUIRED)
stormcellar_package(GIF::GIF find_package GIF REQUIRED)
stormcellar_package(JPEG::JPEG find_package JPEG REQUIRED)
stormcellar_package(fmt::fmt find_package fmt REQUIRED)
stormcellar_package(spdlog::spdlog find_package spdlog REQUIRED)
stormcellar_package(CLI11::CLI11 find_package CLI11 REQUIRED)
stormcellar_package(nlohmann_json::nlohmann_json find_package nlohmann_json REQUIRED)
stormcellar_package(tl::expected find_package tl-expected REQUIRED)
stormcellar_package(SQLiteCpp find_package SQLiteCpp REQUIRED)
set(CMAKE_MODULE_PATH_SAVED ${CMAKE_MODULE_PATH})
list(APPEND CMAKE_MODULE_PATH /usr/share/cmake/geographiclib)
stormcellar_package(GeographicLib find_package GeographicLib REQUIRED)
set(CMAKE_MODULE_PATH ${CMAKE_MODULE_PATH_SAVED})
stormcellar_package(tomlplusplus::tomlplusplus find_package tomlplusplus REQUIRED)
stormcellar_package(date::date-tz find_package date REQUIRED)
stormcellar_package(PkgConfig::xxhash pkg_check_modules xxhash REQUIRED IMPORTED_TARGET libxxhash)
stormcellar_package(PkgConfig::lz4 pkg_check_modules lz4 REQUIRED IMPORTED_TARGET liblz4)
stormcellar_package(PkgConfig::libdeflate pkg_check_modules libdeflate REQUIRED IMPORTED_TARGET libdeflate)
stormcellar_package(PkgConfig::zstd pkg_check_modules zstd REQUIRED IMPORTED_TARGET libzstd)
stormcellar_package(PkgConfig::libarchive pkg_check_modules libarchive REQUIRED IMPORTED_TARGET libarchive)
stormcellar_package(PkgConfig::libcurl pkg_check_modules libcurl REQUIRED IMPORTED_TARGET libcurl)
stormcellar_package(PkgConfig::mosquitto pkg_check_modules mosquitto REQUIRED IMPORTED_TARGET libmosquitto)
stormcellar_package(PkgConfig::pugixml pkg_check_modules pugixml REQUIRED IMPORTED_TARGET pugixml)
stormcellar_package(PkgConfig::webp pkg_check_modules webp REQUIRED IMPORTED_TARGET libwebp libwebpmux)
stormcellar_package(PkgConfig::cairo pkg_check_modules cairo REQUIRED IMPORTED_TARGET cairo cairo-ft)
stormcellar_package(PkgConfig::systemd pkg_check_modules systemd REQUIRED IMPORTED_TARGET libsystemd)
stormcellar_package(PkgConfig::microhttpd pkg_check_modules microhttpd REQUIRED IMPORTED_TARGET libmicrohttpd)
stormcellar_package(PkgConfig::netcdf pkg_check_modules netcdf REQUIRED IMPORTED_TARGET netcdf)
stormcellar_package(PkgConfig::hdf5 pkg_check_modules hdf5 REQUIRED IMPORTED_TARGET hdf5)
stormcellar_package(PkgConfig::hwy pkg_check_modules hwy REQUIRED IMPORTED_TARGET libhwy)
if(STORMCELLAR_GRIB)
  stormcellar_package(PkgConfig::eccodes pkg_check_modules eccodes REQUIRED IMPORTED_TARGET eccodes)
  # eccodes.pc of Debian 12 names a directory that does not exist, and puts a search path into what it links. The
  # headers and the library are in the usual directories.
  set_target_properties(PkgConfig::eccodes PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "" INTERFACE_LINK_DIRECTORIES ""
    INTERFACE_LINK_OPTIONS "" INTERFACE_LINK_LIBRARIES eccodes)
endif()
if(STORMCELLAR_VDB)
  # Debian's package has neither a CMake package nor a file for pkg-config.
  stormcellar_package(openvdb find_library STORMCELLAR_OPENVDB openvdb REQUIRED)
  stormcellar_package(tbb find_library STORMCELLAR_TBB tbb REQUIRED)
endif()
if(STORMCELLAR_VIDEO)
  stormcellar_package(PkgConfig::ffmpeg pkg_check_modules ffmpeg REQUIRED IMPORTED_TARGET
    libavformat libavcodec libavutil libswscale)
endif()
