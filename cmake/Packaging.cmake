# Configures the Debian package, which `cpack --config build/release/CPackConfig.cmake` or the target `package`
# makes. The package installs below /usr, whatever the prefix of the build is.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME stormcellar)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "weather radar volumes: ingest beside LDM, grids, pictures, loops")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
"A service that sits beside Unidata's LDM, watches weather radar volumes
(NEXRAD and TDWR Level II) arrive, catalogs each one, and grids it into a
rolling 3D cache on disk; and a command line that turns that cache into
pictures and loops, queries the catalog, and exports grids as netCDF and
volumes as CfRadial.")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${STORMCELLAR_MAINTAINER})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

# The package has the installed programs and their files, but not the library for other programs.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_CMAKE_PROJECTS
  "${PROJECT_BINARY_DIR};stormcellar;${CMAKE_INSTALL_DEFAULT_COMPONENT_NAME};/"
  "${PROJECT_BINARY_DIR};stormcellar;debian;/")
set(CPACK_STRIP_FILES ON)

# Besides the packages of the shared libraries, the programs need files: fonts, time zones and certificates.
# packaging/debian/postinst needs adduser on machines without systemd-sysusers.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "adduser, ca-certificates, fonts-dejavu-core, tzdata")
set(debian ${PROJECT_SOURCE_DIR}/packaging/debian)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${debian}/postinst ${debian}/prerm ${debian}/postrm
  ${debian}/conffiles)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
