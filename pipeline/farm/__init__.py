# SPDX-FileCopyrightText: The Nightcity authors
# SPDX-License-Identifier: Apache-2.0
"""Shots as batch jobs: OpenJobDescription templates, run through Dask or submitted to Slurm."""
