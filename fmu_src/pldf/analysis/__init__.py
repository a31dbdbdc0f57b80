"""The analysis of a study, real or simulated: statistics, questionnaire, tables."""
