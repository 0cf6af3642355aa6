# fish completion of stormcellar-feed.
complete -c stormcellar-feed -f
complete -c stormcellar-feed -l config -r -F -d 'Read the configuration from FILE'
complete -c stormcellar-feed -l check-config -d 'Check the configuration, and exit'
complete -c stormcellar-feed -l version -d 'Print the version and exit'
complete -c stormcellar-feed -s h -l help -d 'Print the usage and exit'
