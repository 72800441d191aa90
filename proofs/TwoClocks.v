(** * The schedule of two clocks is a palindrome

    - [strikes_times], [strikes_times_late]
                        ticks that strike are exactly the times n h (phase 0) or (n + 1/2) h (phase 1/2);
    - [tick_slow]       p h1 = q h2 makes one tick the same fraction of both steps;
    - [two_clocks_palindrome]
                        for all p, q >= 1 and phases 0 or 1/2 the period is half ++ rev half;
    - [full_period_mirror]
                        Q = mirror H ** H with H the half period, hence the two trace identities;
    - [strikes_middle]  a kick stands at T/2 iff p (fast) or q (slow) is even;
    - [swap_clocks]     the two clocks may change their names;
    - [many_clocks_palindrome]
                        the same for any number of clocks;
    - [event_loop_trace]
                        the staggered algorithm (Algorithm 1 of the paper) has the same trace.        *)

From Kickdrift Require Import Vocabulary Algebra.
From Coq Require Import Reals List Arith Lia Lra.
Import ListNotations.
Open Scope R_scope.

(** ** Ticks and times *)

Lemma strikes_spec m late j :
  (1 <= m)%nat ->
  strikes m late j = true <-> exists n, (j + (if late then m else 0) = n * (2 * m))%nat.
Proof.
  intros M; unfold strikes; rewrite Nat.eqb_eq, Nat.mod_divide by lia; reflexivity.
Qed.

Lemma times_nat q h1 j x :
  (1 <= q)%nat -> 0 < h1 -> INR j * tick q h1 = x * h1 <-> INR j = x * (2 * INR q).
Proof.
  intros Q H; assert (0 < INR q) by (apply lt_0_INR; lia).
  assert (E : INR j * tick q h1 * (2 * INR q) = INR j * h1) by (unfold tick; field; lra).
  split; intros A.
  - apply Rmult_eq_reg_r with h1; [|lra]. rewrite <- E, A; ring.
  - apply Rmult_eq_reg_r with (2 * INR q); [|lra]. rewrite E, A; ring.
Qed.

Theorem strikes_times q h1 j :
  (1 <= q)%nat -> 0 < h1 ->
  strikes q false j = true <-> exists n, INR j * tick q h1 = INR n * h1.
Proof.
  intros Q H; rewrite strikes_spec by assumption; split; intros [n A]; exists n.
  - apply times_nat; [assumption..|].
    rewrite Nat.add_0_r in A; rewrite A, !mult_INR; simpl; ring.
  - apply times_nat in A; [|assumption..].
    apply INR_eq; rewrite Nat.add_0_r, A, !mult_INR; simpl; ring.
Qed.

Theorem strikes_times_late q h1 j :
  (1 <= q)%nat -> 0 < h1 ->
  strikes q true j = true <-> exists n, INR j * tick q h1 = (INR n + 1 / 2) * h1.
Proof.
  intros Q H; rewrite strikes_spec by assumption; split; intros [n A].
  - destruct n as [|n]; [lia|]; exists n; apply times_nat; [assumption..|].
    replace j with (n * (2 * q) + q)%nat by lia.
    rewrite plus_INR, !mult_INR; simpl; field.
  - apply times_nat in A; [|assumption..]; exists (S n).
    apply INR_eq; rewrite plus_INR, A, !mult_INR, S_INR; simpl; field.
Qed.

Theorem tick_slow p q h1 h2 :
  (1 <= p)%nat -> (1 <= q)%nat -> INR p * h1 = INR q * h2 -> tick q h1 = tick p h2.
Proof.
  intros P Q E; assert (0 < INR p) by (apply lt_0_INR; lia); assert (0 < INR q) by (apply lt_0_INR; lia).
  unfold tick; apply Rmult_eq_reg_r with (2 * INR p * INR q); [|nra].
  transitivity (INR p * h1); [field; lra|]. rewrite E; field; lra.
Qed.

(** ** The palindrome *)

Lemma strikes_mirror m late n j :
  (1 <= m)%nat -> (j <= n * (2 * m))%nat -> strikes m late (n * (2 * m) - j) = strikes m late j.
Proof.
  intros M J; apply Bool.eq_iff_eq_true; rewrite !strikes_spec by assumption.
  set (l := if late then m else O).
  assert (L : exists e, (l + l = e * (2 * m))%nat) by (subst l; destruct late; [exists 1%nat|exists O]; lia).
  destruct L as [e L].
  assert (S : (n * (2 * m) - j + l + (j + l) = (n + e) * (2 * m))%nat) by (rewrite Nat.mul_add_distr_r; lia).
  split; intros [k K]; exists (n + e - k)%nat; rewrite Nat.mul_sub_distr_r; lia.
Qed.

Theorem two_clocks_palindrome p q late1 late2 k1 k2 d :
  (1 <= p)%nat -> (1 <= q)%nat ->
  let f := two_clocks p q late1 late2 k1 k2 in
  let h := schedule f d (p * q) in
  schedule f d (2 * (p * q)) = h ++ rev h.
Proof.
  intros P Q f h; apply palindrome_schedule; intros j J; unfold f, two_clocks.
  replace (2 * (p * q))%nat with (p * (2 * q))%nat by lia.
  rewrite strikes_mirror by lia.
  replace (p * (2 * q))%nat with (q * (2 * p))%nat by lia.
  rewrite strikes_mirror by lia; reflexivity.
Qed.

Theorem full_period_mirror p q h1 L1 h2 L2 :
  (1 <= p)%nat -> (1 <= q)%nat ->
  let H := half_period p q h1 L1 h2 L2 in
  let Q := full_period p q h1 L1 h2 L2 in
  det H = 1 /\ Q = mirror H ** H /\
  tr Q - 2 = 4 * (mB H * mC H) /\ tr Q + 2 = 4 * (mA H * mD H).
Proof.
  intros P Q0 H Q; unfold Q, full_period; rewrite two_clocks_palindrome by assumption.
  split; [apply det_propagator|].
  destruct (palindrome (schedule (two_clocks p q false false (h1 * L1) (h2 * L2)) (tick q h1) (p * q)))
    as (E & _ & T1 & T2).
  split; [exact E | split; [exact T1 | exact T2]].
Qed.

Lemma strikes_middle m n : (1 <= m)%nat -> strikes m false (n * m) = Nat.even n.
Proof.
  intros M; apply Bool.eq_iff_eq_true; rewrite strikes_spec, Nat.even_spec by assumption.
  split; intros [k K]; exists k; nia.
Qed.

Theorem swap_clocks p q h1 L1 h2 L2 :
  (1 <= p)%nat -> (1 <= q)%nat -> INR p * h1 = INR q * h2 ->
  full_period q p h2 L2 h1 L1 = full_period p q h1 L1 h2 L2.
Proof.
  intros P Q E; unfold full_period; rewrite <- (tick_slow p q h1 h2 P Q E), (Nat.mul_comm q p).
  f_equal; apply schedule_ext; intros j _; unfold two_clocks; ring.
Qed.

(** ** Any number of clocks *)

Theorem many_clocks_palindrome clocks d n :
  (forall m late k, In (m, late, k) clocks -> (1 <= m)%nat /\ exists c, n = (c * m)%nat) ->
  let f := many_clocks clocks in
  schedule f d (2 * n) = schedule f d n ++ rev (schedule f d n).
Proof.
  intros Fit f; apply palindrome_schedule; intros j J; unfold f; clear f.
  induction clocks as [|[[m late] k] rest IH]; [reflexivity|].
  assert (Cons : forall i, many_clocks ((m, late, k) :: rest) i =
    (if strikes m late i then k else 0) + many_clocks rest i) by reflexivity.
  rewrite !Cons, IH by (intros; apply (Fit m0 late0 k0); now right).
  destruct (Fit m late k) as [M [c ->]]; [now left|].
  replace (2 * (c * m) - j)%nat with (c * (2 * m) - j)%nat by lia.
  rewrite strikes_mirror by lia; reflexivity.
Qed.

(** ** The event loop *)

Theorem event_loop_trace p q h1 L1 h2 L2 :
  (1 <= p)%nat -> (1 <= q)%nat ->
  tr (propagator (staggered (two_clocks p q false false (h1 * L1) (h2 * L2)) (tick q h1) (2 * (p * q))))
  = tr (full_period p q h1 L1 h2 L2).
Proof.
  intros P Q; apply staggered_trace; unfold two_clocks.
  replace (2 * (p * q))%nat with (p * (2 * q) - 0)%nat by lia.
  rewrite strikes_mirror by lia.
  replace (p * (2 * q) - 0)%nat with (q * (2 * p) - 0)%nat by lia.
  rewrite strikes_mirror by lia; reflexivity.
Qed.
