"""The one end of all waiting."""

# s; what is waited for comes within 0.1 s as a rule, discovery without multicast within 7 s; a busy machine gets the rest.
LONGEST_WAIT = 90.0
# s; a service that answered in vain is asked again. A busy server answers in vain now and then, and ten times never.
ASK_AGAIN = 5.0
