# Installs the configuration, manual pages and completions. Runs when the project is installed, because
# CMAKE_INSTALL_PREFIX is known only then. Needs STORMCELLAR_SOURCE, STORMCELLAR_REFERENCE (the output directory of
# make-reference) and PROJECT_VERSION.
include(${STORMCELLAR_SOURCE}/systemd/units.cmake)
stormcellar_sysconfdir(${CMAKE_INSTALL_PREFIX} STORMCELLAR_SYSCONFDIR)
set(STORMCELLAR_DATADIR ${CMAKE_INSTALL_PREFIX}/share)
set(STORMCELLAR_DOCDIR ${CMAKE_INSTALL_PREFIX}/share/doc/stormcellar)
set(work ${STORMCELLAR_REFERENCE}/installed)

foreach(page stormcellar.1 stormcellard.8 stormcellar-web.8 stormcellar-pull.8 stormcellar-feed.8 stormcellar-notify.8 stormcellard.toml.5)
  configure_file(${STORMCELLAR_REFERENCE}/${page} ${work}/${page} @ONLY)
  execute_process(COMMAND gzip -9nf ${work}/${page} COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCH "[0-9]$" section ${page})
  file(INSTALL ${work}/${page}.gz DESTINATION ${STORMCELLAR_DATADIR}/man/man${section})
endforeach()

# zsh in Debian reads site-functions below /usr/local and vendor-completions below /usr.
set(zsh_directory site-functions)
if(CMAKE_INSTALL_PREFIX STREQUAL "/usr")
  set(zsh_directory vendor-completions)
endif()
foreach(program stormcellar stormcellard stormcellar-web stormcellar-pull stormcellar-feed stormcellar-notify)
  set(from ${STORMCELLAR_REFERENCE}/${program})
  file(INSTALL ${from}.bash DESTINATION ${STORMCELLAR_DATADIR}/bash-completion/completions
    RENAME ${program})
  file(INSTALL ${from}.zsh DESTINATION ${STORMCELLAR_DATADIR}/zsh/${zsh_directory} RENAME _${program})
  file(INSTALL ${from}.fish DESTINATION ${STORMCELLAR_DATADIR}/fish/vendor_completions.d)
endforeach()

# Install the explained configuration beside the documentation. Install it as the configuration only if there is
# none yet, so that an operator's changes are kept.
file(READ ${STORMCELLAR_SOURCE}/daemon/stormcellard.toml configuration)
string(REPLACE "/usr/local/share" "${STORMCELLAR_DATADIR}" configuration "${configuration}")
file(WRITE ${work}/stormcellard.toml "${configuration}")
file(INSTALL ${work}/stormcellard.toml DESTINATION ${STORMCELLAR_DOCDIR})
if(NOT EXISTS "$ENV{DESTDIR}${STORMCELLAR_SYSCONFDIR}/stormcellar/stormcellard.toml")
  file(INSTALL ${work}/stormcellard.toml DESTINATION ${STORMCELLAR_SYSCONFDIR}/stormcellar)
endif()
