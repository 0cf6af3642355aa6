# fish completion of stormcellar-web.
complete -c stormcellar-web -f
complete -c stormcellar-web -l config -r -F -d 'Read the configuration from FILE'
complete -c stormcellar-web -l check-config -d 'Check the configuration, and exit'
complete -c stormcellar-web -l version -d 'Print the version and exit'
complete -c stormcellar-web -s h -l help -d 'Print the usage and exit'
