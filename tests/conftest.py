from hypothesis import settings

# Same examples every run, on every machine: a red test means a changed code, not an unlucky draw.
settings.register_profile("repeatable", derandomize=True, database=None, deadline=None)
settings.load_profile("repeatable")
