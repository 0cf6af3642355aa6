# fish completion of stormcellard.
complete -c stormcellard -f
complete -c stormcellard -l config -r -F -d 'What to watch and how'
complete -c stormcellard -l no-loops -d 'Leave the loops to another stormcellard'
complete -c stormcellard -l loops-only -d 'Keep the loops and do nothing else'
complete -c stormcellard -l check-config -d 'Say whether the configuration is right, and end'
complete -c stormcellard -l version -d 'Print the version and end'
complete -c stormcellard -s h -l help -d 'Print the usage and end'
