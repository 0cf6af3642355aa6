#compdef @SERVICE@
_arguments \
  '--config[Read the configuration from FILE]:FILE:_files' \
  '--check-config[Check the configuration, and exit]' \
  '--version[Print the version and exit]' \
  '--help[Print the usage and exit]'
