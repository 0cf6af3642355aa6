# fish completion of stormcellard.
complete -c stormcellard -f
complete -c stormcellard -l config -r -F -d 'Read the configuration from FILE'
complete -c stormcellard -l no-loops -d 'Leave the loops to another stormcellard'
complete -c stormcellard -l loops-only -d 'Run the loops and do nothing else'
complete -c stormcellard -l check-config -d 'Check the configuration, and exit'
complete -c stormcellard -l version -d 'Print the version and exit'
complete -c stormcellard -s h -l help -d 'Print the usage and exit'
