#compdef stormcellard
_arguments \
  '--config[What to watch and how]:FILE:_files' \
  '(--loops-only)--no-loops[Leave the loops to another stormcellard]' \
  '(--no-loops)--loops-only[Keep the loops and do nothing else]' \
  '--check-config[Say whether the configuration is right, and end]' \
  '--version[Print the version and end]' \
  '--help[Print the usage and end]'
