#compdef stormcellard
_arguments \
  '--config[Read the configuration from FILE]:FILE:_files' \
  '(--loops-only)--no-loops[Leave the loops to another stormcellard]' \
  '(--no-loops)--loops-only[Run the loops and do nothing else]' \
  '--check-config[Check the configuration, and exit]' \
  '--version[Print the version and exit]' \
  '--help[Print the usage and exit]'
