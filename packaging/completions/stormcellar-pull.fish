# fish completion of stormcellar-pull.
complete -c stormcellar-pull -f
complete -c stormcellar-pull -l config -r -F -d 'Read the configuration from FILE'
complete -c stormcellar-pull -l check-config -d 'Check the configuration, and exit'
complete -c stormcellar-pull -l version -d 'Print the version and exit'
complete -c stormcellar-pull -s h -l help -d 'Print the usage and exit'
