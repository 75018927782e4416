"""Views of gears: engagement, generating, trains and reducers, their equations and tables."""
