# fish completion of @SERVICE@.
complete -c @SERVICE@ -f
complete -c @SERVICE@ -l config -r -F -d 'Read the configuration from FILE'
complete -c @SERVICE@ -l check-config -d 'Check the configuration, and exit'
complete -c @SERVICE@ -l version -d 'Print the version and exit'
complete -c @SERVICE@ -s h -l help -d 'Print the usage and exit'
