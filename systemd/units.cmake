# The parts that depend on the prefix: the units, and the directory of the configuration. Included when the tree is
# configured, and again when it is installed, possibly below another prefix.

# Sets `variable` to the prefix's directory for configuration files, for example /etc for /usr.
function(stormcellar_sysconfdir prefix variable)
  if(prefix STREQUAL "/usr" OR prefix STREQUAL "/")
    set(${variable} /etc PARENT_SCOPE)
  else()
    set(${variable} ${prefix}/etc PARENT_SCOPE)
  endif()
endfunction()

# Writes the units for an installation below `prefix` to `directory`; `libdir` is relative to the prefix.
function(stormcellar_write_units source prefix libdir directory)
  stormcellar_sysconfdir(${prefix} STORMCELLAR_SYSCONFDIR)
  set(STORMCELLAR_BINDIR ${prefix}/bin)
  set(STORMCELLAR_LIBDIR ${prefix}/${libdir})
  set(STORMCELLAR_DOCDIR ${prefix}/share/doc/stormcellar)
  file(READ ${source}/hardening.conf STORMCELLAR_HARDENING)
  string(CONFIGURE "${STORMCELLAR_HARDENING}" STORMCELLAR_HARDENING @ONLY)
  foreach(unit stormcellard stormcellar-loops stormcellar-web stormcellar-pull stormcellar-feed stormcellar-notify)
    configure_file(${source}/${unit}.service.in ${directory}/${unit}.service @ONLY)
  endforeach()
endfunction()
